// A table of symbols in the same text as its program, below it, above it or between its networks.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "interpreter/stl/is_instruction.hpp"

namespace s7200 {

/// A program and its table. Each has blank lines in place of those of the other.
struct ProgramWithTable {
  std::string program, table;
};

/// Nothing if the text has no such table, or nothing else. A table begins with headings, `Symbol;Address`; without them, its
/// rows, `Motor = Q0.0`, are a table only if at least half of their names are in statements.
std::optional<ProgramWithTable> table_in_program(std::string_view text, const stl::IsInstruction& is_instruction);

}  // namespace s7200
