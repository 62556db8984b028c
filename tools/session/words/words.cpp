#include "tools/session/words/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/model/area.hpp"
#include "interpreter/model/cpu_model.hpp"

namespace s7200::tools {

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

namespace {

/// Whether a word is the letters of an address whose number follows: `VW`
bool is_letters_of_address(std::string_view word) {
  const std::string letters = stl::upper_case(word);
  if (area_named(letters)) return true;
  const bool sized = !letters.empty() && std::string_view("BWD").find(letters.back()) != std::string_view::npos;
  return sized && area_named(std::string_view(letters).substr(0, letters.size() - 1));
}

}  // namespace

std::vector<std::string> parts_between_commas(std::string_view text, bool assignments) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  char quote = '\0';
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (quote != '\0')
      quote = c == quote ? '\0' : quote;
    else if (c == '\'' || c == '"')
      quote = c;
    else if (c == ',' && (!assignments || at + 1 == text.size() || text.find('=', at) != text.npos)) {
      parts.emplace_back(stl::trim(text.substr(begin, at - begin)));
      begin = at + 1;
    }
  }
  parts.emplace_back(stl::trim(text.substr(begin)));
  return parts;
}

std::vector<std::string> assignments_of(const std::vector<std::string>& arguments) {
  std::vector<std::string> texts;
  bool open = false;
  for (const std::string& argument : arguments) {
    const bool number = stl::is_digit(argument.front()) && !texts.empty() && is_letters_of_address(texts.back());
    if ((open || number || argument.front() == '=') && !texts.empty())
      texts.back() += argument;
    else
      texts.push_back(argument);
    open = argument.back() == '=';
  }
  std::vector<std::string> all;
  for (const std::string& text : texts)
    for (std::string& part : parts_between_commas(text, true))
      if (!part.empty()) all.push_back(std::move(part));
  return all;
}

std::string expects(std::string_view command, std::string_view what) { return fmt::format("{} expects {}", command, what); }

std::string no_argument(std::string_view command) { return fmt::format("{} takes no argument", command); }

std::string without_power_text(std::string_view plc) {
  return fmt::format("{} is without power; 'power on' brings it back", plc);
}

std::optional<std::uint32_t> parse_count(const std::vector<std::string>& arguments) {
  if (arguments.empty()) return 1;
  const auto number = parse_decimal<std::uint32_t>(arguments[0]);
  return arguments.size() == 1 && number && *number > 0 ? number : std::nullopt;
}

std::optional<std::uint8_t> event_of(const std::vector<std::string>& words) {
  if (words.size() != 2 || stl::lower_case(words[0]) != "event") return {};
  const auto number = parse_decimal<std::uint8_t>(words[1]);
  return number && find_event(*number) ? number : std::nullopt;
}

std::string expects_event(std::string_view command, const std::vector<std::string>& words) {
  std::uint8_t last = kEvents - 1;
  while (!find_event(last)) --last;
  const auto number = words.size() == 2 ? parse_decimal<std::uint64_t>(words[1]) : std::nullopt;
  return fmt::format("{}{} one address, or event and a number up to {}, for example: {}{}event 8",
                     number ? fmt::format("there is no event {}; ", *number) : "",
                     command.empty() ? "expected" : fmt::format("{} expects", command), last, command,
                     command.empty() ? "" : " ");
}

std::optional<bool> wants_end(const std::vector<std::string>& arguments) {
  const std::string word = arguments.empty() ? "begins" : stl::lower_case(joined(arguments));
  if (word == "begins" || word == "begin") return false;
  return word == "ends" || word == "end" ? std::optional(true) : std::nullopt;
}

}  // namespace s7200::tools
