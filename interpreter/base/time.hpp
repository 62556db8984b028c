// Simulated time.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace s7200 {

/// Nanoseconds since the simulated power-up. 64 bits hold 292 years.
using Time = std::int64_t;

inline constexpr Time kMicrosecond = 1'000;
inline constexpr Time kMillisecond = 1'000'000;
inline constexpr Time kSecond = 1'000'000'000;

/// A time later than anything that happens.
inline constexpr Time kNever = std::numeric_limits<Time>::max();

/// Reads a duration as the command line writes it: `250ms`, `2s`, `1h`, `1.5ms`, `40us`, `100ns`, `3min`.
/// A blank before the unit is allowed. Returns nothing if the unit is missing, or if the figure is negative, unreadable,
/// finer than a nanosecond or longer than 292 years.
std::optional<Time> parse_duration(std::string_view text);

/// Parses a duration like parse_duration(), but gives kNever for one longer than 292 years.
std::optional<Time> parse_duration_or_never(std::string_view text);

/// The shortest of these forms with up to `digits` decimals, rounded: 690.123 ms, 40 us, 2 s. Minutes and hours are used
/// only if they are whole: 90 s, 2 min. kNever is `never`.
std::string format_duration(Time duration, int digits = 3);

}  // namespace s7200
