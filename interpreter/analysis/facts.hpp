// What the warnings ask of a program, worked out once.
#pragma once

#include <vector>

#include "interpreter/analysis/effects.hpp"
#include "interpreter/analysis/flow.hpp"

namespace s7200 {

struct Facts {
  const Program& program;
  ControlFlow flow;
  std::vector<std::vector<MemoryAccess>> effects;  ///< by op: effects_of()
};

/// `program` must live as long as what is returned.
Facts facts_of(const Program& program);

}  // namespace s7200
