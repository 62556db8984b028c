// Finds the word that was probably meant.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace s7200 {

/// The words of `known` that need the fewest letters changed, added or left out, at most `most_changes` (0 to 2) of them, in
/// their order; empty if none is so close.
std::vector<std::string_view> all_nearest(std::string_view word, std::span<const std::string_view> known,
                                          std::size_t most_changes);

/// The first of them; two changes are too many in a word of fewer than four letters. Empty if none is close.
std::string_view nearest(std::string_view word, std::span<const std::string_view> known);

}  // namespace s7200
