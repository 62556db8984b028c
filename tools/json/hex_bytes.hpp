// Bytes within JSON, in hex.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace s7200::tools {

/// Nothing if something else than pairs of hex digits is in it.
std::optional<std::string> bytes_of_hex(std::string_view hex);

}  // namespace s7200::tools
