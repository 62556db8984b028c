// Bytes in a text of JSON: base64 (RFC 4648).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace s7200::tools {

std::string to_base64(std::span<const std::uint8_t> bytes);

/// Nothing for what is not base64.
std::optional<std::vector<std::uint8_t>> from_base64(std::string_view text);

}  // namespace s7200::tools
