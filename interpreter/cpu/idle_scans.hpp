// Passes over scans in which the program changes nothing, exactly, from any instant of the system's part of a scan to any
// other one: between two events too, however soon they follow each other.
//
// When is a program idle? Once it has been executed from its beginning to its end, and has left everything in its footprint
// (footprint.hpp) as it was. From then on it is known: whenever a program begins with these values in its footprint, it
// takes the same time, executes as many instructions, and leaves the state as it is.
//
// When is a scan idle? If its program is, and the system has nothing to do in it but to spend its time: no value to force or
// to save, no request to answer, no input or output to take over, no timer that counts. Then the state after any time
// follows from the time alone (move_on). An event ends that, whatever it does; after it the footprint is looked at again,
// so an interrupt that writes elsewhere costs a comparison.
//
// When does it pay? To take a footprint costs as much as about a hundred executions of the program. Once a footprint is
// known, the next one has to wait, the longer the less the last one was worth.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include "interpreter/cpu/footprint.hpp"
#include "interpreter/cpu/steady_scans.hpp"

namespace s7200 {

class IdleScans {
 public:
  explicit IdleScans(SteadyScansUse use) : use_(use) {}

  /// Finds out, in the system's part of a scan, whether idle scans follow.
  bool look(Core& core);

  /// Moves the CPU on by idle scans, which follow, until before `horizon` at most: to there, or to the beginning of the
  /// scan whose program is being executed then. Returns by how much.
  Time pass_over(Core& core, Time horizon);

  /// Whether idle scans follow from here until next_change(), unless something comes from outside.
  bool known(const Core& core) const { return known_ && !core.touched && core.s.time <= change_; }
  /// The instant until which the program finds the clock bits as they are, if it looks at them; kNever if not.
  Time next_change() const { return change_; }

  /// Something is different: whether idle scans follow is not known.
  void forget();

  /// Whether the program that is about to begin is to be executed by learn(). If something else is executed, the question
  /// is forgotten.
  bool learns(const State& s) { return std::exchange(asked_, false) && !s.in_interrupt && s.pc == 0; }
  /// Executes the program up to the loop's `until`, and remembers it if it is an idle one.
  void learn(Core& core);

  /// The instant at which the CPU has to stop so that Check can compare; kNever for none.
  Time stop_at() const { return expected_ ? expected_->time : kNever; }

 private:
  bool lie_ahead(const Core& core);
  static bool is_idle(const Core& core, const State& before, const Footprint& footprint);
  void remember(const Core& core, const Footprint& footprint, Time time, std::uint64_t instructions);
  void move_on(const Core& core, State& s, Time until) const;
  Time position(const State& s) const;
  void go_to(State& s, Time position) const;
  void check(const Core& core);
  void expect(const Core& core, Time horizon);

  /// Where the parts of an idle scan begin, from its own beginning on.
  struct Parts {
    Time program = 0, communication = 0, self_test = 0, write_outputs = 0, end = 0;
  };

  SteadyScansUse use_;
  Footprint footprint_{};
  std::unique_ptr<State> idle_{};  // at the end of the program of which the footprint is; null: of none
  Parts parts_{};
  std::uint64_t instructions_ = 0;  // of that program
  bool known_ = false;              // that idle scans follow, if nothing has touched the CPU since
  Time change_ = kNever;
  bool asked_ = false;                       // to learn the next program
  std::uint64_t learn_at_ = kFirst;          // number of instructions executed before that
  std::uint64_t wait_ = kFirst;              // instructions since the last idle scan before a program is learnt
  std::uint64_t patience_ = kLeastPatience;  // as many times the instructions of the program that was learnt last
  std::uint64_t worth_ = 0;                  // instructions passed over since then
  std::unique_ptr<State> expected_{};        // of Check
  std::uint64_t expectations_ = 0;

  static constexpr std::uint64_t kFirst = 1'000, kCost = 100, kLeastPatience = 4 * kCost, kMostPatience = 128 * kCost;
  static constexpr std::uint64_t kCheckEvery = 16;
};

}  // namespace s7200
