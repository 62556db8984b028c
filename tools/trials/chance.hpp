// Trials by chance, made of what a program listens to. The same seed makes the same trials.
#pragma once

#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

#include "interpreter/base/split_mix.hpp"
#include "interpreter/cpu/state.hpp"
#include "tools/trials/trial.hpp"
#include "tools/trials/vocabulary.hpp"

namespace s7200::tools {

class Chance {
 public:
  explicit Chance(std::uint64_t seed) : state_(split_mix(seed + 1)) {}
  std::uint64_t draw() { return draw_split_mix(state_); }
  std::uint64_t below(std::uint64_t end) { return end == 0 ? 0 : draw() % end; }
  bool one_in(std::uint64_t times) { return below(times) == 0; }
  std::uint8_t byte() { return static_cast<std::uint8_t>(draw()); }
  template <class List>
  const auto& one_of(const List& list) {
    return list[static_cast<std::size_t>(below(std::size(list)))];
  }

 private:
  std::uint64_t state_;
};

class TrialMaker {
 public:
  TrialMaker(Vocabulary words, std::uint64_t seed) : words_(std::move(words)), chance_(seed) {}

  /// What may come next, for a PLC in this state. Time alone goes by if nothing else reaches the program.
  Stimulus next(const State& now);

  /// Any frame: a request that was answered, changed in its fields, lengths, CRC and gaps, cut, doubled or glued to another
  /// one; characters that the program compares with; or noise.
  Stimulus frame();

  /// What goes wrong around a program: a character with a wrong parity or stop bit, a break, power that fails.
  Stimulus disturbance();

  /// A frame that is a little different from one that has led to something new.
  void remember(const std::vector<std::uint8_t>& frame);

  Chance& chance() { return chance_; }
  const Vocabulary& words() const { return words_; }

 private:
  Time wait();
  std::uint32_t value();
  std::vector<std::uint8_t> well_formed();
  std::vector<std::uint8_t> write_of_several();
  std::vector<std::uint8_t> characters();
  void change(std::vector<std::uint8_t>& frame);

  Vocabulary words_;
  Chance chance_;
  std::vector<std::vector<std::uint8_t>> remembered_{};
};

}  // namespace s7200::tools
