// The time of day on the command line: `2026-11-21 10:00:00`.
#pragma once

#include <optional>
#include <string_view>

#include "interpreter/cpu/state.hpp"

namespace s7200::tools {

/// A date between 1990 and 2089 that exists, with its day of the week; nothing for anything else.
std::optional<ClockTime> parse_clock(std::string_view text);

}  // namespace s7200::tools
