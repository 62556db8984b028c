// The names of a table's rows as messages list them.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace s7200::stl {

/// The texts that `text_of`, a member or a function, gives for the rows, with `between` in between: "a, b, c".
template <class Rows, class TextOf>
std::string joined(const Rows& rows, TextOf text_of, std::string_view between = ", ") {
  std::string text;
  for (const auto& row : rows) {
    if (!text.empty()) text += between;
    text += std::invoke(text_of, row);
  }
  return text;
}

}  // namespace s7200::stl
