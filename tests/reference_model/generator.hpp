// Random programs for a CPU that the checker accepts, and random memory for them to meet.
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "interpreter/model/instruction.hpp"
#include "tests/reference_model/memory.hpp"

namespace s7200::reference {

class Generator {
 public:
  Generator(std::uint64_t seed, const CpuModel& model);

  /// Main program, some subroutines and an interrupt routine that is never called.
  std::string program();

  /// Fills memory with values that matter: limits, zeros, pointers good and bad, tables, digits, reals.
  void fill(Memory& memory);

  /// Any number less than `n`.
  std::size_t below(std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_); }

 private:
  bool chance(std::size_t percent) { return below(100) < percent; }
  template <class T>
  const T& one_of(const std::vector<T>& choices) {
    return choices[below(choices.size())];
  }

  // program
  void line(const std::string& text) { text_ += text + "\n"; }
  void body(std::uint8_t part, int level);
  void item(std::uint8_t part, int level);
  void rung(std::uint8_t part, const std::string& last = "");
  void loop(std::uint8_t part, int level);
  void jump_over(std::uint8_t part, int level);
  void jump_back(std::uint8_t part, int level);
  void segment(std::uint8_t part, int level);
  void timer_with_reset(std::uint8_t part);
  std::string load();
  std::string statement(const s7200::Instruction& instruction);
  std::string operand(const OperandRule& rule);
  std::string constant(const OperandRule& rule);
  std::string number(const OperandRule& rule);
  std::string direct(const OperandRule& rule);
  std::string timer(const OperandRule& rule);
  std::string string_constant();
  std::string special_memory(const OperandRule& rule);
  std::uint32_t place_in_v(const OperandRule& rule);
  std::string address(const std::string& area, Width width, std::uint32_t number);

  // memory
  std::uint32_t interesting(std::size_t width);
  std::uint32_t pointer();
  std::uint32_t real_bits();
  void random_bytes(Bytes& bytes, std::size_t from, std::size_t count);
  void table(Bytes& bytes, std::size_t at);
  void string(Bytes& bytes, std::size_t at);

  std::size_t size_of(std::string_view area) const { return model_.size_of(*area_named(area)); }
  bool is_free(const s7200::Instruction& instruction) const;

  const CpuModel& model_;
  std::mt19937_64 random_;
  std::vector<const s7200::Instruction*> logic_, outputs_;
  std::string text_;
  std::size_t subroutines_ = 0;
  std::size_t labels_ = 0;
  std::size_t routine_ = 0;  ///< 0 the main program, then the subroutines: each has S bits of its own
  bool in_segment_ = false;
};

}  // namespace s7200::reference
