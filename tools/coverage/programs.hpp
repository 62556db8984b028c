// Programs as several runs have them.
#pragma once

#include <vector>

#include "interpreter/analysis/flow/flow.hpp"

namespace s7200::tools {

/// Whether both have the same name, CPU and text; their times may differ.
bool is_same_program(const Program& a, const Program& b);

/// By op: whether some way leads to it, from the main program and from what calls and attaches.
std::vector<bool> reachable_ops(const ControlFlow& flow);

}  // namespace s7200::tools
