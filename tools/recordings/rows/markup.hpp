// Logs that have been through a web page, Markdown or a program that draws tables: their rows without what is around them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace s7200::tools {

struct WithoutMarkup {
  std::string text{};
  std::string note{};  ///< which lines were left out, or why they have other numbers; empty if there is nothing to say
};

/// The text without the tags and entities of HTML, or without the outer bars and the ruled lines of tables; bars stay
/// between cells. Nothing if it has none of them. Rows of HTML become a line each; in any other table lines keep their
/// numbers.
std::optional<WithoutMarkup> without_markup(std::string_view text);

}  // namespace s7200::tools
