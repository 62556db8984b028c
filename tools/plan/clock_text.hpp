// The time of day on the command line, `2026-11-21 10:00:00`, and how far a clock is off, `50ppm`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "interpreter/cpu/state.hpp"
#include "interpreter/model/cpu_model.hpp"

namespace s7200::tools {

/// A date between 1990 and 2089 that exists, with its day of the week; nothing for anything else.
std::optional<ClockTime> parse_clock(std::string_view text);

/// Empty if it has a clock that can be set.
std::string why_no_clock(const CpuModel& model);

/// Parses a clock's error in millionths: `-50ppm`, from -1000ppm to 1000ppm; nothing for anything else.
std::optional<std::int32_t> parse_clock_error(std::string_view text);

}  // namespace s7200::tools
