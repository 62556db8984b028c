// Visits all places in a source that was read from a text.
#pragma once

#include <functional>

#include "interpreter/stl/parser.hpp"

namespace s7200::stl {

/// Calls `move` on every position in what was read. A line alone is a position with column 0, of which the line is kept.
void move_places(ParseResult& read, const std::function<void(Position&)>& move);

}  // namespace s7200::stl
