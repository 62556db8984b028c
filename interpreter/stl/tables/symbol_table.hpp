// Reads symbol tables and recognises status charts, as they are exported, copied from a window or from a page: cells
// separated by tabs, semicolons, commas, bars or blanks.
//
// A row of a symbol table has a name, an address and perhaps more, in columns that headings may name; cells may be in
// quotes. What the headings say counts, whatever the other columns hold. Rows with one cell are headings of tables.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "interpreter/stl/parser.hpp"

namespace s7200::stl {

/// Whether `text` (UTF-8) is a symbol table. `is_mnemonic` tells one from a listing with a tab after each mnemonic.
bool is_symbol_table(std::string_view text, const std::function<bool(std::string_view word)>& is_mnemonic);

/// Whether a line is the heading of such a table: `Symbol;Address;Comment`.
bool is_head_of_symbols(std::string_view line);

ParseResult read_symbol_table(std::string_view text, std::string name);

/// `symbol Pump has no address`: of a name that its table has without one. It is the cause of the error about a wrong
/// address.
std::string why_without_address(std::string_view name);

/// Whether it is a status chart: addresses with formats and values, of which nothing is part of a program. A table with
/// headings for a symbol and its address is none.
bool is_status_chart(std::string_view text);

}  // namespace s7200::stl
