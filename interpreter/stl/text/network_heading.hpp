// Headings of networks as people write them: `Netzwerk 1`, `Network 2 - Start`, `=== Network 3 ===`, `[Network 4] Stop`.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace s7200::stl::plain {

/// A heading of a network that is not written as STL has it.
struct NetworkHeading {
  std::size_t begin = 0, end = 0;  ///< of what stands for `NETWORK` and its number
  std::string_view number{}, title{};
  bool framed = false;  ///< the title is within brackets or rules, where no statement is
  bool sure = true;     ///< nothing but a heading is written so; else a sentence may begin so: `Network 3 starts the pump`
};

/// The length of a word for a network in any of several languages, `NETWORK` too, at the beginning of a text; 0 if there is
/// none.
std::size_t network_word(std::string_view text);

/// The heading that a line is, whatever its title: `NETWORK 3 LD I0.0` has one that is a statement. Nothing for `NETWORK 3`
/// itself, with a comment or without, and for any other line.
std::optional<NetworkHeading> network_heading(std::string_view line);

}  // namespace s7200::stl::plain
