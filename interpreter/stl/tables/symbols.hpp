// Names and the addresses that they stand for: symbols, variables of blocks, blocks, and the symbols that the programming
// software has by itself.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/stl/parser.hpp"

namespace s7200::stl {

/// The number of a block, which it has beside its name: `SBR0`, `INT12`, `OB1`
struct BlockNumber {
  Block::Kind kind;
  std::uint32_t number;
};

std::optional<BlockNumber> block_number(std::string_view text);

/// Whether an operand may be a name all the same: S1 has no bit, Z1 and AW1 are addresses only in the German set, K1 is a
/// constant only for Micro/DOS.
bool may_be_name(const OperandValue& value, std::string_view written);

/// The symbol of this name, with or without quotes; in other capitals if only one symbol can be meant; otherwise the one
/// that the programming software has. Null if there is none.
const Symbol* find_symbol(const std::vector<Symbol>& symbols, std::string_view name);

/// Puts the addresses of symbols, of local variables and of blocks in place of their names. A name that nothing defines
/// stays, with the reason.
void resolve_symbols(ParseResult& result);

/// The names in the statements of a resolved program that have their address beside them, `Pump:Q0.0`, and that neither its
/// tables nor the programming software define: in the order of their first place, each once. Local variables are not among them.
std::vector<Symbol> names_beside_addresses(const Source& source);

/// The first name in the statements of a program that only Micro/WIN SMART has by itself; empty if there is none. Names that
/// the program defines do not count.
std::string symbol_of_smart(const Source& source);

}  // namespace s7200::stl
