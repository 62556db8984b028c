// The control flow of a program: where each op leads, which routines there are, and who starts them.
//
// Plain data, worked out from the decoded ops alone. What a program with errors leaves open (program/loading/unread.hpp) may lead to
// the next op and end its routine; calls and attachments of what is unread name no routine.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "interpreter/program/program.hpp"

namespace s7200 {

/// The main program, a subroutine or an interrupt routine.
struct Routine {
  enum class Kind : std::uint8_t { Main, Subroutine, Interrupt };

  Kind kind = Kind::Main;
  std::uint8_t number = 0;           ///< of SBR or INT
  std::uint32_t first = 0, end = 0;  ///< its ops: from the first, which is its SBR or INT, until before `end`
};

/// What may follow an op.
struct FlowNode {
  std::vector<std::uint32_t> next;  ///< ops of the same routine, one of which follows; after a CALL, when that has returned
  bool ends = false;                ///< the routine or the scan may end with it
  bool powered = false;             ///< the top of the logic stack is surely 1 in front of it
  bool powered_if_active = false;   ///< the same while its segment is active; outside segments as `powered`
  std::uint32_t routine = 0;        ///< in ControlFlow::routines
  std::uint32_t network = 0;        ///< the first op of its network
};

/// A CALL.
struct CallSite {
  std::uint32_t op = 0;
  std::uint32_t routine = 0;  ///< in ControlFlow::routines
};

/// An ATCH.
struct Attachment {
  std::uint32_t op = 0;
  std::optional<std::uint32_t> routine;  ///< in ControlFlow::routines; nothing: unread, or there is none
  std::optional<std::uint8_t> event;     ///< nothing: unread
};

struct ControlFlow {
  std::vector<Routine> routines;  ///< the main program first, then in the order of their ops
  std::vector<FlowNode> nodes;    ///< by op
  std::vector<CallSite> calls;
  std::vector<Attachment> attachments;

  const Routine& routine_of(std::uint32_t op) const { return routines[nodes[op].routine]; }
};

/// What it takes grows with the number of ops only. An interrupt may come between any two ops, and is no part of the nodes.
///
/// JMP, CRET, END, STOP and so on go one way only where the top of the logic stack is surely 1: after LD SM0.0, or where
/// nothing has been loaded in a subroutine. Between LSCR and SCRE it never surely is.
ControlFlow control_flow(const Program& program);

}  // namespace s7200
