// Reads symbol tables and recognises status charts, as tab-separated text or CSV.
//
// A row of a symbol table has a name, an address and perhaps a comment, in columns that a heading may name; cells may be in
// quotes. Rows with one cell are headings of tables.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/stl/parser.hpp"

namespace s7200::stl {

/// Whether `text` (UTF-8) is a symbol table. `is_mnemonic` tells one from a listing with a tab after each mnemonic.
bool is_symbol_table(std::string_view text, const std::function<bool(std::string_view word)>& is_mnemonic);

ParseResult read_symbol_table(std::string_view text, std::string name);

/// Whether it is a status chart: addresses with formats and values, of which nothing is part of a program.
bool is_status_chart(std::string_view text);

/// Whether an operand may be a name all the same: S1 has no bit, Z1 and AW1 are addresses only in the German set, K1 is a
/// constant only for Micro/DOS.
bool may_be_name(const OperandValue& value, std::string_view written);

/// The symbol of this name, with or without quotes; written in other capitals if it can be no other. Null if there is none.
const Symbol* find_symbol(const std::vector<Symbol>& symbols, std::string_view name);

/// Puts the addresses of symbols, of local variables and of blocks in place of their names. A name that nothing defines
/// stays, with the reason.
void resolve_symbols(ParseResult& result);

}  // namespace s7200::stl
