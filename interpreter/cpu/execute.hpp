// How the loops execute an instruction, op by op.
#pragma once

#include "interpreter/cpu/core.hpp"

namespace s7200 {

/// Executes the next instruction, or passes over it if it needs power flow and has none. The caller counts it.
inline void execute_next(Core& core, const Op* ops, Time no_power_flow) {
  State& s = core.s;
  core.loop.op = s.pc;
  const Op& op = ops[s.pc];
  if (op.power_mask & ~s.stack.bits()) {
    s.time += no_power_flow;
    s.pc = op.skip_to;
    s.eno &= !op.sets_eno;
  } else {
    s.time += op.cost;
    ++s.pc;
    op.body(core, op);
  }
}

}  // namespace s7200
