// JSON that comes from outside, read within limits.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "interpreter/base/result.hpp"

namespace s7200::tools {

/// How much a JSON text may have.
struct JsonLimits {
  std::size_t bytes = 64 << 20;
  std::size_t depth = 64;        ///< maps and lists inside each other: what handles them calls itself for each
  std::size_t members = 10'000;  ///< of one map: each is compared with all before it
};

/// Trouble if the text is not JSON, or has more of something than `limits` allow. What it says completes a
/// sentence that begins with "it is": `not JSON`.
Result<nlohmann::ordered_json> parse_json(std::string_view text, const JsonLimits& limits = {});

/// A value as JSON in one line; what is not UTF-8 in it as U+FFFD.
std::string in_one_line(const nlohmann::ordered_json& value);

/// A value for a message, at most 40 characters of it.
std::string shown(const nlohmann::ordered_json& value);

}  // namespace s7200::tools
