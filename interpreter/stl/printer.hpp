// Prints a syntax tree as canonical STL.
#pragma once

#include <string>

#include "interpreter/stl/ast.hpp"

namespace s7200::stl {

/// An operand as text: international addresses, constants in the form in which they were written (K4 becomes 4, KHFF becomes
/// 16#FF), a symbol before its address. `16#49`, `VB100`, `*AC1`, `&VB0`, `'AB'`, `Pump:Q0.0`
std::string to_text(const Operand& operand);

/// The shortest text that reads back as the same value, with a point or an exponent to mark it as a real: `1.5`, `1E+10`,
/// `INF`, `NAN`.
std::string to_text(const Real& constant);

/// A statement as text, without the comment: `MOVW    65, VW3290`
std::string to_text(const Statement& statement);

/// The whole source, with its comments aligned and a blank line before each routine head and network and after each routine.
/// Reads back as the same program.
std::string to_text(const Source& source);

}  // namespace s7200::stl
