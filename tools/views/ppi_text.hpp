// What PPI carries, in words.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace s7200::tools {

/// A variable's return code, or the high byte of a whole answer's error.
std::string_view s7_error_name(std::uint8_t code);

/// The clock in the data of user data: `2026-11-22 15:45:30`. Empty if there is none, as in the answer to one that was set.
std::string s7_clock_text(std::span<const std::uint8_t> data);

}  // namespace s7200::tools
