// The longest ways through a program by time, with conditions on the same unchanged value taken together: where a byte is 3,
// what it is called for as 4 takes no time.
//
// A routine is followed op by op with the logic stack and with the numbers and bits that its contacts look at, a way for
// each that differ; subroutines are followed with what their callers know. Of numbers it is known what reaching_values.hpp
// computes, that a copy stays like its original, that a word to which only constants are moved holds one of them, and that
// `MOVW VW0, AC0` and `+I VW2, AC0` make a sum: without overflow none of two numbers that are not negative is above it. Of
// too many ways in front of an op the shortest are taken for one that may be any of them. In the passes of a loop, and after
// it, nothing is known of what they write. Nothing is known either of what interrupt routines write, of local memory, of
// timers and counters, and of what the system changes.
//
// A loop counts as often as FOR counts on the way, as DEC counts down to 0 in front of `LDN SM1.0` and its JMP back, as a
// number to which each pass adds a constant goes to the limit of a comparison in front of the JMP, or as it is known at any
// time, whichever is less. A pointer that may lead anywhere in an area is taken not to lead to what is
// followed, as in reaching_values.hpp.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "interpreter/analysis/effects/facts.hpp"

namespace s7200 {

struct LongestWay {
  Time time = 0;                        ///< in ns, to the end of the routine or of the stretch
  std::optional<Time> to_transmission;  ///< to the end of the last XMT on the way; nothing: no way leads to one
  Time instruction = 0;                 ///< the longest one on any way
  std::set<std::uint32_t> loops{};      ///< FOR and JMP back without a bound, CALLs of recursion: each counts once
  std::map<std::uint32_t, std::int64_t> passes{};  ///< of loops with a bound, the most on any way
};

class LongestWays {
 public:
  /// How often the loop of a FOR or a JMP back runs at most, whatever leads to it; nothing: that is not known.
  using Times = std::function<std::optional<std::int64_t>(std::uint32_t op)>;
  /// What is taken for granted on all ways.
  struct Assumed {
    std::vector<std::pair<Bits, bool>> bits{};  ///< with their values
    std::vector<bool> disturbing{};             ///< by routine: whether it may come between any two instructions
    std::uint32_t port = 0;                     ///< whose XMT are meant
  };

  /// `timed`: the program of `facts`, with the times to count with; it has no errors. All must live as long as this. If
  /// `waiter` asks to end, no result means anything.
  LongestWays(const Facts& facts, const Program& timed, Times times, const Waiter& waiter)
      : facts_(facts), timed_(timed), times_(std::move(times)), waiter_(waiter) {}

  /// `routines`: in ControlFlow::routines. For each what it takes from its beginning.
  std::vector<LongestWay> of_routines(const std::vector<std::uint32_t>& routines, const Assumed& assumed) const;
  /// From `from` until an op outside of [from, to), all of one routine.
  LongestWay of_stretch(std::uint32_t from, std::uint32_t to, const Assumed& assumed) const;

 private:
  class Follower;
  const Facts& facts_;
  const Program& timed_;
  Times times_;
  const Waiter& waiter_;
};

}  // namespace s7200
