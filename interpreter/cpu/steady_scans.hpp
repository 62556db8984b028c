// Passes over scans that are all alike, exactly.
//
// When may scans be passed over? A pair of scans (SM0.6 alternates) is run and looked at, from the end of the program in one
// scan to the same place two scans later. They are steady if the whole state afterwards is the state before, moved on by
// the rules for what goes on by itself (move_on): clock, counts of scans and instructions, deadlines, timers, clock
// bits; if the same timers are on between them; and if nothing was done to the CPU, or by it to the outside (touched).
//
// Why is it exact? The next pair begins with the same state, but for what goes on by itself. Of that, the program looks only
// at what Looks says; as long as none of it changes, the pair does the same again. So whole pairs are passed over until
// before the earliest of: the end of the run, the next event, the next change of a clock bit or of the time of day that the
// program reads, the tick that brings a timer to its preset, or any tick of a timer of which every tick may matter. The scan
// in which something happens is run.
//
// The same function moves the state on by one pair for the comparison, and by many to pass them over.
//
// A program that changes nothing is known by what it reads and writes, which is quicker and lasts longer (idle_scans.hpp);
// where that is known, pairs are not looked for.
//
// When does it pay? A look costs about as much as a thousand instructions. What it may bring, the instructions until the
// horizon and the parts of the scans besides them, has to be worth a stake, which doubles with each look that was in vain
// and is halved with each that was not. In real time a look is always worth it: it may spare waking up (alike_until).
#pragma once

#include <cstdint>
#include <memory>

#include "interpreter/cpu/core.hpp"

namespace s7200 {

enum class SteadyScansUse : std::uint8_t {
  Off,
  On,     ///< where it pays
  Eager,  ///< wherever it is possible: for real time, and for tests
  Check   ///< passes over nothing: predicts the state, runs every scan, and compares. A difference ends the process
};

/// The mode if nothing else is asked for: the dev build checks what the release build does.
#ifdef S7200_CHECK_STEADY_SCANS
inline constexpr SteadyScansUse kUsualUse = SteadyScansUse::Check;
#else
inline constexpr SteadyScansUse kUsualUse = SteadyScansUse::On;
#endif

class IdleScans;

class SteadyScans {
 public:
  SteadyScans();
  ~SteadyScans();

  void use(SteadyScansUse use);

  /// Moves the CPU on, in the system's part of a scan, until before `limit` at most. Returns by how much.
  Time pass_over(Core& core, Time limit);

  /// Whether the program that is about to begin is to be executed by learn(), up to the loop's `until`.
  bool learns(const State& s) const;
  void learn(Core& core);

  /// The instant at which the CPU has to stop so that Check can compare; kNever for none.
  Time stop_at() const;

  /// Simulated time that was passed over so far.
  Time passed_over() const { return passed_; }

  /// The number of times that a pair of scans was looked at so far.
  std::uint64_t looks() const { return looks_; }

  /// The instant until which all scans are alike, unless something comes from outside; the CPU's time as long as that is not
  /// known.
  Time alike_until(const Core& core) const;
  /// The same, after a look whether the program is an idle one, in the system's part of a scan.
  Time look_ahead(Core& core);

 private:
  enum class Known : std::uint8_t { Nothing, Before, Middle, Pair };

  bool is_looking() const { return known_ == Known::Before || known_ == Known::Middle; }
  bool is_idle(Core& core);
  Time go_on(Core& core, Time limit);
  void begin_look(const Core& core, Time horizon);
  void in_vain(const Core& core);
  void end_look(const Core& core);
  Time pass(Core& core, Time horizon);
  void check(const Core& core);
  void move_on(const Core& core, State& s, std::uint64_t pairs) const;

  SteadyScansUse use_ = kUsualUse;
  std::unique_ptr<IdleScans> idle_;
  Known known_ = Known::Nothing;
  std::unique_ptr<State> before_{};  // the pair
  Time middle_ = 0;                  // when the program of the pair's first scan began
  Time length_ = 0;                  // of a pair
  Time second_ = 0;                  // from the begin of the program in the first scan to that in the second
  std::uint64_t instructions_ = 0;   // in a pair
  Time change_ = 0;                  // until when nothing changes by itself, since the begin of the look
  std::uint64_t look_at_ = 0;        // number of instructions executed before the next look
  std::uint64_t stake_ = kFirstStake;
  Time passed_ = 0;
  std::uint64_t looks_ = 0;
  std::unique_ptr<State> expected_{};  // of Check

  static constexpr std::uint64_t kLeastStake = 2'000, kFirstStake = 20'000, kMostStake = 1'000'000;
};

}  // namespace s7200
