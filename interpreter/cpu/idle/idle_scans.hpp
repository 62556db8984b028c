// Passes over scans in which the program changes nothing, exactly, from any instant of a scan to any other one: between two
// events too, however soon they follow each other.
//
// When is a program idle? Once it has been executed from its beginning to its end, and has left everything in its footprint
// (footprint.hpp) as it was. From then on it is known: whenever a program begins with these values in its footprint, it
// takes the same time, executes as many instructions, and leaves the state as it is.
//
// When is a scan idle? If its program is, and the system has nothing to do in it but to spend its time: no value to force or
// to save, no request to answer, no input or output to take over, no timer that counts. Then the state after any time
// follows from the time alone (move_on). In the program those instants are known at which everything in the footprint was as
// before it and no subroutine was open (Step); from the last of them before an event on, the program is executed. An event
// ends all that, whatever it does; after it the footprint is looked at again, so an interrupt that writes elsewhere costs a
// comparison.
//
// When does it pay? To take a footprint costs as much as about a hundred executions of the program. Once a footprint is
// known, the next one has to wait, the longer the less the last one was worth.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "interpreter/cpu/idle/footprint.hpp"
#include "interpreter/cpu/steady_scans.hpp"

namespace s7200 {

class IdleScans {
 public:
  explicit IdleScans(SteadyScansUse use) : use_(use) {}

  /// Finds out whether idle scans follow, from within one or from its beginning on.
  bool look(Core& core);

  /// Moves the CPU on by idle scans, which follow, until before `horizon` at most: to there, or to the last known instant
  /// in the program before. Returns by how much.
  Time pass_over(Core& core, Time horizon);

  /// Whether idle scans follow from here until next_change(), unless something comes from outside.
  bool known(const Core& core) const { return known_ && !core.touched && core.s.time <= change_; }
  /// The instant until which the program finds the clock bits as they are, if it looks at them; kNever if not.
  Time next_change() const { return change_; }

  /// Something is different: whether idle scans follow is not known.
  void forget();

  /// Whether the program that is about to begin is to be executed by learn(). If something else is executed, the question
  /// is forgotten.
  bool learns(const State& s) { return asked_ && std::exchange(asked_, false) && !s.in_interrupt && s.pc == 0; }
  /// Executes the program up to the loop's `until`, and remembers it if it is an idle one.
  void learn(Core& core);

  /// The instant at which the CPU has to stop so that Check can compare; kNever for none.
  Time stop_at() const { return expected_ ? expected_->time : kNever; }

 private:
  /// An instant in the program at which the state is as before it, but for this.
  struct Step {
    Time at = 0;  ///< since the beginning of the program
    std::uint32_t op = 0;
    std::uint32_t last_op = 0;  ///< the one executed before it
    std::uint64_t executed = 0;
    LogicStack stack{};
    bool rail = true, eno = true;
  };

  bool lie_ahead(const Core& core);
  const Step* step_at(const State& s) const;
  const Step& step_before(Time at) const;
  bool knows_instant(const Core& core) const;
  static bool is_idle(const Core& core, const State& before, const Footprint& footprint);
  void remember(const Core& core, const Footprint& footprint, std::vector<Step> steps, Step end);
  const Step* move_on(const Core& core, State& s, Time until) const;
  Time position(const State& s) const;
  void go_to(State& s, Time position) const;
  static void set(State& s, const Step& step);
  void expect(const Core& core, Time horizon);

  /// Where the parts of an idle scan begin, from its own beginning on.
  struct Parts {
    Time program = 0, communication = 0, self_test = 0, write_outputs = 0, end = 0;
  };

  SteadyScansUse use_;
  Footprint footprint_{};
  std::unique_ptr<State> idle_{};  // at the end of the program of which the footprint is; null: of none
  Parts parts_{};
  Step end_{};                               // of that program
  std::vector<Step> steps_{};                // in it, the first one at its beginning
  std::vector<std::uint32_t> step_of_op_{};  // by op: the number of its last step, from 1 on, or kNoStep
  bool known_ = false;                       // that idle scans follow, if nothing has touched the CPU since
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
  static constexpr std::uint32_t kNoStep = 0;
};

}  // namespace s7200
