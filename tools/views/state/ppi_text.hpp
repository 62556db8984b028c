// The contents of PPI messages, in words.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace s7200::tools {

/// A variable's return code, or the error of a whole answer, which has two bytes.
std::string_view s7_error_name(std::uint16_t code);

/// The clock in the data of user data: `2026-11-22 15:45:30`. Empty if there is none, as in the answer after the clock was
/// set.
std::string s7_clock_text(std::span<const std::uint8_t> data);

/// The name of a block in S7: `DB1`.
std::string s7_block_text(std::span<const std::uint8_t> name);

/// The CPU's identification, s7::kIdentificationBytes: `CPU 226, release 02.00`; in quotation marks if it is not one.
std::string s7_identification_text(std::span<const std::uint8_t> bytes);

}  // namespace s7200::tools
