// Expressions in STL terms: `VW3300 > 8 and M31.7`, `VD20:real * 2`, `*AC1 = 16#03`, `not SM3.0`.
//
// Bytes have no sign, words and double words have one, as the instructions take them; a constant like 16#FFFF is compared
// bit by bit with a word. `*VD100` is the byte that the pointer points to; `*VD100:word`, `:dword`, `:real` are wider;
// `&VB0` is a pointer to VB0.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/result.hpp"
#include "interpreter/cpu/cpu.hpp"
#include "interpreter/program/operands/address.hpp"

namespace s7200::tools {

/// An address as people look at it: direct, or what a pointer points to.
struct Place {
  MemoryRange range;  ///< of the pointer, if it is one
  bool pointer = false;
  Width width = Width::Byte;  ///< of what the pointer points to
  std::uint32_t count = 1;
  bool real = false;
};

/// The area and number that a place of the image belongs to.
std::optional<MemoryRange> range_at(std::uint32_t at, Width width, const CpuModel& model);

/// `VB0:16`, `VD20:real`, `*VD3570:4`, `*AC1:word`. Trouble if it is not an address of this CPU.
Result<Place> parse_place(std::string_view text, const Program& program);

/// Where that is now; nothing for a pointer that points nowhere.
std::optional<MemoryRange> range_now(const Place& place, const Cpu& cpu);

/// What a pointer holds.
std::uint32_t pointer_value(const Place& place, const Cpu& cpu);

struct Value {
  double number = 0;  ///< exact for all integers of 32 bits
  bool real = false;
  std::uint8_t bits = 0;  ///< of the memory it came from; 0: computed, or a constant

  bool truth() const { return number != 0; }
};

/// The bits of an integer that fits a double word, with a sign or without; nothing of anything else.
std::optional<std::uint32_t> double_word_of(const Value& value);

/// The bits of a real as a double word holds them, and of an integer that fits one.
std::optional<std::uint32_t> bits_of(const Value& value);

/// `7`, `1.5`
std::string number_text(const Value& value);

class Expression {
 public:
  struct Node;

  /// Trouble with the column, if it cannot be read.
  static Result<Expression> parse(std::string_view text, const Program& program);

  /// What is forced has its forced value outside, while the program finds what it has put there itself.
  enum class SeenBy : std::uint8_t { Program, Outside };

  /// Trouble where a pointer points nowhere, and by division by 0.
  Result<Value> value(const Cpu& cpu, SeenBy by = SeenBy::Program) const;

  /// `VW20 is 7, M0.1 is 0`: all its places, as they are written in it; empty if it has none.
  std::string places_text(const Cpu& cpu, SeenBy by = SeenBy::Program) const;

  /// The addresses in it, each once.
  std::vector<Place> places() const;

  /// Those that keep it from being true, or false, as seen outside: of `and`, `or` and `not` only what would have to be
  /// otherwise.
  std::vector<Place> places_against(bool wanted, const Cpu& cpu) const;

  const std::string& text() const { return text_; }

 private:
  std::string text_;
  std::shared_ptr<const Node> root_;
};

}  // namespace s7200::tools
