// Reads data blocks, the initial V memory of a Micro/WIN project.
//
//   line   : [ address ] { value } [ '//' comment ]
//   value  : 1, -5, 16#FF, 2#1010, 3.14, 'text', "string"
//
// Commas, blanks and tabs separate; a line without an address goes on where the line before it ended. What the values mean
// and whether they fit is for program/loading/data_block to say.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "interpreter/stl/parser.hpp"

namespace s7200::stl {

/// Whether `text` (UTF-8) is a data block: most of its lines begin with an address of V memory, with a value, or with a
/// symbol and a value; at least one has an address. `is_mnemonic` tells symbols from instructions.
bool is_data_block(std::string_view text, const std::function<bool(std::string_view word)>& is_mnemonic);

ParseResult read_data_block(std::string_view text, std::string name);

/// Adds one line of a data block to Source::data, or messages.
void read_data_line(std::string_view line, std::uint32_t number, ParseResult& result);

}  // namespace s7200::stl
