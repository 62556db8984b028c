// Lines that keep to the width of a screen.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace s7200::stl {

/// The width of a line in characters where no terminal has another.
inline constexpr std::size_t kUsualWidth = 100;

/// The text with its longer lines broken at blanks, so that none has more than `width` characters. A broken line goes on
/// below its last column, which begins after two or more blanks; a line without columns goes on at its own indentation. A
/// single word that is wider stays whole. Control sequences of colours take no room.
std::string wrapped(std::string_view text, std::size_t width);

/// Breaks lines in the same way, but a broken line goes on after `indent` blanks.
std::string wrapped(std::string_view text, std::size_t width, std::size_t indent);

}  // namespace s7200::stl
