// A source made of several files: exports, symbol tables, data blocks.
#pragma once

#include "interpreter/stl/parser.hpp"

namespace s7200::stl {

/// Adds a file to a source: its lines follow those that are there already, and messages name it.
void append(ParseResult& source, ParseResult file);

}  // namespace s7200::stl
