// Programs as several runs have them.
#pragma once

#include <memory>
#include <vector>

#include "tools/views/inspection/inspection.hpp"

namespace s7200::tools {

/// Whether both have the same name, CPU and text; their times may differ.
bool is_same_program(const Program& a, const Program& b);

/// By op: whether some way leads to it, from the main program and from what calls and attaches.
std::vector<bool> reachable_ops(const ControlFlow& flow);

/// A program whose places are to be named and whose flow is asked for. Where its pointers lead, which takes longer to work
/// out than many a run, is left open.
Inspection for_places(std::shared_ptr<const Program> program);

}  // namespace s7200::tools
