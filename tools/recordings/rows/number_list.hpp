// Bytes as numbers that are not pairs of hex digits: a list of a language, or hex without leading zeros.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "tools/recordings/recording.hpp"

namespace s7200::tools {

/// Numbers at the end of a line: `[1, 3, 0, 0, 0, 2, 196, 11]`, `TX: 1 3 0 0 0 2 C4 B`.
struct NumberList {
  std::size_t begin = 0;            ///< place of the first number in the line
  std::string_view odd{};           ///< the first number that is not a pair of digits
  std::vector<Reading> readings{};  ///< their bytes in hex and in decimal, as far as they can be that
};

/// Finds a list of four numbers or more, in brackets or after a direction, of which several are not pairs of digits: a
/// single one may be a damaged byte. Returns nothing if there is none.
std::optional<NumberList> number_list_at_end(std::string_view line);

}  // namespace s7200::tools
