// A table of symbols in the same text as its program, below it, above it or between its networks.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace s7200 {

/// A program and its table. Each has blank lines in place of those of the other.
struct ProgramWithTable {
  std::string program, table;
};

/// Nothing if the text has no such table, or nothing else. A table begins with headings, `Symbol;Address`; without them, its
/// rows, `Motor = Q0.0`, are a table only if at least half of their names are in statements. `is_instruction` says whether a
/// mnemonic in capitals takes so many operands.
std::optional<ProgramWithTable> table_in_program(
    std::string_view text, const std::function<bool(std::string_view mnemonic, std::size_t operands)>& is_instruction);

}  // namespace s7200
