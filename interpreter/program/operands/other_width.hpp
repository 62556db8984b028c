// The instruction that does the same with operands of another width.
#pragma once

#include <string>

#include "interpreter/model/cpu_model.hpp"
#include "interpreter/model/instruction.hpp"
#include "interpreter/stl/ast.hpp"

namespace s7200 {

/// `MOVB 1, SMB31` for `MOVW 1, SMB31`: the statement with the instruction that takes all its operands as they are written,
/// constants included. Empty if there is none on the CPU, or if the operands have the width of the instruction.
std::string in_other_width(const Instruction& instruction, const stl::Statement& statement, const CpuModel& model);

}  // namespace s7200
