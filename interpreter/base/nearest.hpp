// The word that was probably meant.
#pragma once

#include <span>
#include <string_view>

namespace s7200 {

/// The word of `known` that needs the fewest letters changed, added or left out; empty if none is close.
std::string_view nearest(std::string_view word, std::span<const std::string_view> known);

}  // namespace s7200
