// The word that was probably meant.
#pragma once

#include <span>
#include <string_view>

namespace s7200 {

/// The one of `known` with the fewest letters to change, add or leave out; empty when none is near.
std::string_view nearest(std::string_view word, std::span<const std::string_view> known);

}  // namespace s7200
