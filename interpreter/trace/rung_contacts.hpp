// Which contacts of a rung have made the power flow at its end: branches that LPP and LRD have left are not among them.
#pragma once

#include <vector>

#include "interpreter/program/program.hpp"
#include "interpreter/trace/trace.hpp"

namespace s7200 {

/// `executed` are all contacts of the rung so far, in their order, with ALD, OLD, LPS, LRD, LPP, LDS and NOT. Those of the
/// top of the logic stack, with ALD, OLD and NOT; all of them if the stack had something in front of them that they use.
std::vector<InstructionRecord> contacts_of_top(const Program& program, const std::vector<InstructionRecord>& executed);

}  // namespace s7200
