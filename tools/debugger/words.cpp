#include "tools/debugger/words.hpp"

#include <fmt/format.h>

#include "interpreter/base/text.hpp"

namespace s7200::tools {

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (stl::is_upper(c)) c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

std::string expects(std::string_view command, std::string_view what) { return fmt::format("{} expects {}", command, what); }

}  // namespace s7200::tools
