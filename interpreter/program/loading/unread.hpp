// Programs with errors: what could not be read. It is met by the search for warnings, and by nothing that runs.
//
// Of a statement with a wrong operand the operand is unread (Operand::unread), and a statement that says nothing is an
// unread op. Both may be anything.
#pragma once

#include "interpreter/program/program.hpp"

namespace s7200 {

/// A statement of which nothing is known: it may do anything to memory and leave its routine.
const Instruction& unread_instruction();
inline bool is_unread(const Op& op) { return op.instruction == &unread_instruction(); }
bool has_unread(const Program& program);

}  // namespace s7200
