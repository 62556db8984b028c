// Strings of the reference model (facts 10.7).
#pragma once

#include <initializer_list>
#include <string>

#include "tests/reference_model/machine.hpp"

namespace s7200::reference {

/// The characters of operand `i`: a constant in double quotes, or from the length byte on.
std::string string_in(Machine& m, std::size_t i);

/// All pointers are followed before anything else is looked at: those of operands of these widths.
void follow_pointers(Machine& m, std::initializer_list<std::size_t> widths);

}  // namespace s7200::reference
