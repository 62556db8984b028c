// AST to canonical STL.
#pragma once

#include <string>

#include "interpreter/stl/ast.hpp"

namespace s7200::stl {

/// `16#49`, `VB100`, `*AC1`, `&VB0`, `'AB'`: international mnemonics and addresses, constants in the form they were written
/// in (K4 becomes 4, KHFF becomes 16#FF).
std::string to_text(const Operand& operand);

/// `1.5`, `1E+10`, `INF`, `NAN`: the shortest form that reads back to the same value; a point or an exponent makes it a
/// real.
std::string to_text(const Real& constant);

/// `MOVW    65, VW3290` without comment.
std::string to_text(const Statement& statement);

/// The whole source: comments kept and aligned, a blank line before each routine head and network and after each routine.
/// Reads back to the same program.
std::string to_text(const Source& source);

}  // namespace s7200::stl
