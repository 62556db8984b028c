// Trials by chance, made of what a program listens to. The same seed makes the same trials.
#pragma once

#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
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

  /// The most edges that come one after the other: a minute of them. A counter that counts further is not counted to its
  /// end.
  static constexpr std::uint32_t kMostEdges = 6000;

  /// What may come next, for a PLC in this state: one stimulus, or an input that is switched on and off as often as a
  /// counter counts. Time alone goes by if nothing else reaches the program.
  Trial next(const State& now);

  /// The state some scans after the last of next(): of memory that was set it is learnt which comparisons it decides, and
  /// what was learnt is forgotten if it proves wrong a few times running. Once alone may be for another reason.
  void learn(const State& after);

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
  /// A comparison whose difference changes by as much as the memory that decides it.
  struct Decided {
    std::size_t comparison = 0;  ///< in words_
    bool against = false;        ///< it shrinks as the memory grows
    int wrong = 0;               ///< times running that it was not so
  };
  /// Memory that was set last.
  struct Set {
    Vocabulary::Bytes place;
    std::uint32_t before = 0, value = 0;
    std::vector<std::uint32_t> differences;  ///< of all comparisons, before it was set
  };

  static void note(std::vector<Decided>& known, std::size_t comparison, bool against, bool is_so);
  Time wait();
  std::uint32_t value();
  std::uint32_t value_for(const Vocabulary::Bytes& place, const State& now);
  Stimulus set_memory(const Vocabulary::Bytes& place, const State& now);
  Stimulus switch_inputs(const State& now);
  Trial pulses(const State& now);
  std::vector<std::uint8_t> well_formed();
  std::vector<std::uint8_t> write_of_several();
  std::vector<std::uint8_t> characters();
  void change(std::vector<std::uint8_t>& frame);

  Vocabulary words_;
  Chance chance_;
  std::vector<std::vector<std::uint8_t>> remembered_{};
  std::optional<Set> set_{};
  std::map<std::uint32_t, std::vector<Decided>> decides_{};  // by place
};

}  // namespace s7200::tools
