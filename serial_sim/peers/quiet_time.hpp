// How long a master leaves the line quiet: before its first request, and between an answer and the next request.
#pragma once

#include <fmt/format.h>

#include <string>

#include "interpreter/base/serial_format.hpp"
#include "interpreter/base/time.hpp"

namespace s7200::serial {

// More than the time-outs of programs that look for 3.5 characters of silence with a timer of whole milliseconds.
inline constexpr int kQuietSilences = 2;  ///< of 3.5 characters
inline constexpr int kQuietCharacters = 7 * kQuietSilences / 2;
inline constexpr Time kQuietMilliseconds = 10;

constexpr Time default_quiet(const SerialFormat& format) {
  return kQuietSilences * format.silence() + kQuietMilliseconds * kMillisecond;
}

/// The default quiet time for help texts and reports.
inline std::string default_quiet_text() { return fmt::format("{} characters + {}ms", kQuietCharacters, kQuietMilliseconds); }

}  // namespace s7200::serial
