// `time=2026-11-27T10:00:00.000Z level=debug dir=tx data="01 03 00 0a"` in each line, as structured loggers write it.
#include <algorithm>
#include <cctype>

#include "interpreter/base/text.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/lines.hpp"
#include "tools/recordings/named_fields.hpp"

namespace s7200::tools {
namespace {

bool is_of_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.' || c == '@'; }

/// A value in quotation marks to the next mark, any other to the next blank.
std::string_view take_value(std::string_view& rest) {
  const bool quoted = rest.starts_with('"');
  if (quoted) rest.remove_prefix(1);
  const std::size_t end = std::min(rest.find_first_of(quoted ? "\"" : " \t"), rest.size());
  const std::string_view value = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return value;
}

struct Pairs {
  std::string_view before{};  ///< what stands before the first
  NamedFields fields{};
};
Pairs pairs_of(std::string_view line) {
  Pairs pairs;
  std::string_view rest = line;
  while (true) {
    const std::size_t equals = rest.find('=');
    if (equals == std::string_view::npos) return pairs;
    std::size_t begin = equals;
    while (begin > 0 && is_of_name(rest[begin - 1])) --begin;
    if (pairs.fields.empty()) pairs.before = line.substr(0, static_cast<std::size_t>(rest.data() - line.data()) + begin);
    const std::string name(rest.substr(begin, equals - begin));
    rest.remove_prefix(equals + 1);
    const std::string_view value = take_value(rest);
    if (!name.empty()) pairs.fields.push_back({.name = name, .value = std::string(value)});
  }
}

}  // namespace

bool looks_like_key_values(std::string_view bytes) {
  constexpr std::size_t kFewest = 2;  // pairs of a line with a frame: `tx=0103` alone may stand in any log
  return is_text(bytes) && std::ranges::any_of(Lines(beginning_of(bytes)), [](std::string_view line) {
           const Pairs pairs = pairs_of(line);
           return pairs.fields.size() >= kFewest && has_frame(pairs.fields);
         });
}

std::optional<LineRecording> read_key_values(std::string_view bytes, const ReadingChoices&, std::string&) {
  NamedFieldsReader reader;
  std::size_t number = 0;
  for (const std::string_view line : Lines(bytes)) {
    ++number;
    const Pairs pairs = pairs_of(line);
    if (!pairs.fields.empty())
      reader.take(pairs.fields, pairs.before, number);
    else if (!stl::trim(line).empty())
      reader.take_other(number);
  }
  return reader.finish();
}

}  // namespace s7200::tools
