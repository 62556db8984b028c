// What does the same as a statement that its instruction does not take: one of another width, or two.
#pragma once

#include <string>

#include "interpreter/model/cpu_model.hpp"
#include "interpreter/model/instruction.hpp"
#include "interpreter/stl/ast.hpp"

namespace s7200 {

/// `MOVB 1, SMB31` for `MOVW 1, SMB31`: the statement with the instruction that takes all its operands as they are written,
/// constants included. Empty if there is none on the CPU, or if the operands have the width of the instruction.
std::string in_other_width(const Instruction& instruction, const stl::Statement& statement, const CpuModel& model);

/// `write MOVW VW0, VW4, then +I VW2, VW4` for `+I VW0, VW2, VW4`: an instruction that works on its output, and is written
/// with the inputs and the output of its box. Empty for any other statement.
std::string in_steps(const Instruction& instruction, const stl::Statement& statement);

}  // namespace s7200
