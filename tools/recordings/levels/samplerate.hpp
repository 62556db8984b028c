// Sample rates of logic analysers.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace s7200::tools {

/// Samples a second: `1000000`, `1 MHz`, `500kHz`, `2.4 MHz`, `1G`. From 1 to 100 GHz; nothing for anything else.
std::optional<std::uint64_t> samplerate_of(std::string_view text);

}  // namespace s7200::tools
