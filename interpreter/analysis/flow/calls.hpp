// Who calls whom, and which interrupt routine runs at which event.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "interpreter/analysis/flow/flow.hpp"
#include "interpreter/model/cpu_model.hpp"

namespace s7200 {

/// An interrupt event that the program attaches or detaches.
struct EventUse {
  std::uint8_t number = 0;
  std::vector<Attachment> attached;     ///< by op
  std::vector<std::uint32_t> detached;  ///< the DTCH, by op
};

struct Calls {
  /// By routine, in ControlFlow::routines.
  struct Node {
    std::vector<CallSite> calls;         ///< what it calls, by op
    std::vector<CallSite> called;        ///< where it is called: `routine` is the one that does
    std::vector<std::uint8_t> events;    ///< that start it
    bool by_main = false;                ///< the main program executes it, directly or through others
    bool by_interrupt = false;           ///< so does an interrupt routine, or it is an attached one
    std::optional<std::uint32_t> depth;  ///< calls below it, one in the other: 0 if it calls nothing; nothing if it recurs
    bool executed() const { return by_main || by_interrupt; }
  };
  std::vector<Node> nodes;
  std::vector<EventUse> events;                        ///< in the order in which the CPU serves them
  std::vector<std::uint32_t> enabling, disabling;      ///< ENI, DISI
  std::vector<std::vector<std::uint32_t>> recursions;  ///< routines that call each other in a circle, each circle once
};

Calls calls_of(const Program& program, const ControlFlow& flow);

/// Why a routine is never executed: `SBR 7 is never called`; nothing if something starts it.
std::optional<std::string> why_never_executed(const ControlFlow& flow, const Calls& calls, std::uint32_t routine);

/// What leads to the last execution of an op in a scan: CALLs, the outermost first, and the op itself. Of two that begin in
/// the same routine, the greater one is executed last.
std::vector<std::uint32_t> last_way_to(const ControlFlow& flow, std::uint32_t op);

}  // namespace s7200
