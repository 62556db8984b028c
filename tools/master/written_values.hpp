// Values of coils and registers as people write them.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "tools/views/state/register_text.hpp"

namespace s7200::tools {

/// Parses bits such as `on,off,1,0`. Throws std::invalid_argument.
std::vector<std::uint16_t> parse_bits(std::string_view text);

/// Parses registers from -32768 to 65535: `1234,-5,16#04D2,2#1010`. In a form of 32 bits each value takes two registers, and
/// the form float takes 1.5e3 too. Throws std::invalid_argument.
std::vector<std::uint16_t> parse_registers(std::string_view text, const ValueFormat& format);

/// A number from `least` to `most`, in the notations above. Throws std::invalid_argument naming it by `what`.
std::int64_t parse_number(std::string_view text, std::int64_t least, std::int64_t most, std::string_view what);

}  // namespace s7200::tools
