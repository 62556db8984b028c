// Rows of cells whose columns have no names.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace s7200::tools {

/// The text with such rows as time, direction and bytes, in whatever order they have them: `TX;01 03 …;10:00:00,000`,
/// `10:00:00.000,Out,01 03 …`. Other cells have a word or a number each. Nothing if there is no such row.
std::optional<std::string> without_bare_cells(std::string_view text);

}  // namespace s7200::tools
