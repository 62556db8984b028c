#include "tools/debugger/words.hpp"

#include <fmt/format.h>

#include "interpreter/base/numbers.hpp"
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

std::string counted(std::size_t count, std::string_view thing) {
  return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

std::vector<std::string> assignments_of(const std::vector<std::string>& arguments) {
  std::vector<std::string> texts;
  bool open = false;
  for (const std::string& argument : arguments) {
    if ((open || argument.front() == '=') && !texts.empty())
      texts.back() += argument;
    else
      texts.push_back(argument);
    open = argument.back() == '=';
  }
  return texts;
}

std::string expects(std::string_view command, std::string_view what) { return fmt::format("{} expects {}", command, what); }

std::string no_argument(std::string_view command) { return fmt::format("{} takes no argument", command); }

std::optional<std::uint32_t> parse_count(const std::vector<std::string>& arguments) {
  if (arguments.empty()) return 1;
  const auto number = parse_decimal<std::uint32_t>(arguments[0]);
  return arguments.size() == 1 && number && *number > 0 ? number : std::nullopt;
}

std::optional<bool> wants_end(const std::vector<std::string>& arguments) {
  const std::string word = arguments.empty() ? "begins" : lower_case(joined(arguments));
  if (word != "begins" && word != "ends") return {};
  return word == "ends";
}

}  // namespace s7200::tools
