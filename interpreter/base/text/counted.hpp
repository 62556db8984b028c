// The number of things, in words.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace s7200 {

/// The noun for a number that stands elsewhere or not at all: `character`, `characters`.
inline std::string noun(std::uint64_t count, std::string_view thing) {
  return fmt::format("{}{}", thing, count == 1 ? "" : "s");
}

/// A number with its noun: `1 character`, `2 characters`
inline std::string counted(std::uint64_t count, std::string_view thing) {
  return fmt::format("{} {}", count, noun(count, thing));
}

}  // namespace s7200
