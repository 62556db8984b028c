// A source text and the places in it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace s7200::stl {

/// A place in a source text. Lines and columns count from 1, columns in characters (not bytes); 0 means no place.
struct Position {
  std::uint32_t line = 0;
  std::uint32_t column = 0;
  std::uint32_t length = 1;  ///< characters to underline

  bool operator==(const Position&) const = default;
};

/// A text as it was read, for messages and listings.
struct SourceLines {
  std::string name;               ///< for messages: the path, or a name in its place
  std::vector<std::string> text;  ///< UTF-8, without line ends
};

}  // namespace s7200::stl
