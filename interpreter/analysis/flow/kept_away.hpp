// Where interrupts are surely kept away: behind DISI until ENI, or behind the DTCH of their event until its ATCH.
//
// Surely means: on every way that leads there. DISI has to have power flow on it, a FOR may run no pass, a segment may be
// inactive, and the end of a pass comes in front of the next one. What has power flow in the rung of a DISI comes behind it.
//
// With the gate the other way round, where they are surely not disabled: on every way there, an ENI is behind the last DISI.
#pragma once

#include <compare>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "interpreter/analysis/flow/flow.hpp"

namespace s7200 {

/// Which ops let interrupts come if they are executed, and which keep them away if they have power flow.
struct InterruptGate {
  std::function<bool(const Op&)> opens, closes;  ///< of instructions that need power flow
};

/// ENI and DISI.
InterruptGate gate_of_all_interrupts();

/// Ops of a routine, and what they call.
struct DisabledStretch {
  std::uint32_t first = 0, end = 0;
};

/// Where interrupts may be disabled from each DISI on; nothing if they may still be when the routine of one returns.
std::optional<std::vector<DisabledStretch>> disabled_stretches(const Program& program, const ControlFlow& flow,
                                                               const std::vector<std::uint32_t>& disabling);

/// Where events of an ATCH may come before interrupts are enabled for the first time: from the first such ATCH to the ENI.
/// Nothing if that ENI may not be executed in the same scan.
std::optional<std::vector<DisabledStretch>> stretches_before_enabling(const Program& program, const ControlFlow& flow);

/// An execution of a routine: below how many calls, and whether interrupts are kept away when it begins.
struct Execution {
  std::uint32_t routine = 0, depth = 0;  ///< in ControlFlow::routines
  bool kept_away = false;

  std::strong_ordering operator<=>(const Execution&) const = default;
};

class KeptAway {
 public:
  /// CALLs in `left_out`, by op, count as not executed, and so do those that are deeper than the CPU nests them. All must
  /// live as long as this.
  KeptAway(const Program& program, const ControlFlow& flow, const std::vector<bool>& left_out, InterruptGate gate)
      : program_(program), flow_(flow), left_out_(left_out), gate_(std::move(gate)) {}

  /// Whether no interrupt comes when an op of the routine is executed; one that needs power flow, when it has it.
  bool in_front(const Execution& execution, std::uint32_t op);
  /// Whether none comes in front of it, with power flow and without.
  bool whatever_flows(const Execution& execution, std::uint32_t op);
  /// Whether the execution may come to an op.
  bool reaches(const Execution& execution, std::uint32_t op) { return place(execution, way(execution), op).reached; }
  /// Whether none comes when the routine returns.
  bool behind(const Execution& execution) { return way(execution).behind; }
  /// The execution that a CALL begins.
  Execution called(const Execution& caller, std::uint32_t call);

 private:
  /// What is so in front of an op.
  struct Place {
    bool reached = false;
    bool powered = true;    ///< interrupts are kept away if the segment is active and the top of the logic stack is 1
    bool unpowered = true;  ///< they are if it is active and the top is 0
    bool inactive = true;   ///< they are if the segment is not active

    bool always() const { return powered && unpowered; }
    void set_always(bool now) { powered = unpowered = now; }
    bool operator==(const Place&) const = default;
  };
  struct Way {
    std::vector<Place> places;  ///< by op of the routine
    bool behind = true;
  };

  const Way& way(const Execution& execution);
  const Routine& routine_of(const Execution& execution) const { return flow_.routines[execution.routine]; }
  Place place(const Execution& execution, const Way& way, std::uint32_t op) const;
  bool follows(const Execution& execution, std::uint32_t op) const;
  bool lead_on(const Execution& execution, Way& way, std::uint32_t op);
  Place after(const Execution& execution, std::uint32_t op, Place now);
  Place after_box(const Op& op, Place now) const;
  Place on_edge(std::uint32_t op, std::uint32_t next, const Place& after) const;

  const Program& program_;
  const ControlFlow& flow_;
  const std::vector<bool>& left_out_;
  InterruptGate gate_;
  std::map<Execution, Way> ways_{};
};

}  // namespace s7200
