// `time=2026-11-27T10:00:00.000Z level=debug dir=tx data="01 03 00 0a"` in each line, as structured loggers write it.
#include <algorithm>
#include <cctype>

#include "interpreter/base/text/text.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/rows/lines.hpp"
#include "tools/recordings/rows/named_fields.hpp"
#include "tools/recordings/rows/notation.hpp"

namespace s7200::tools {
namespace {

bool is_of_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.' || c == '@'; }

/// A value in quotation marks to the next mark, with its escapes read; any other to the next blank, and with bytes after it,
/// `data=01 03 00`, to the last of them.
std::string take_value(std::string_view& rest) {
  const bool quoted = rest.starts_with('"');
  if (quoted) rest.remove_prefix(1);
  std::size_t end = std::min(rest.find_first_of(quoted ? "\"" : " \t"), rest.size());
  while (quoted && end > 0 && end < rest.size() && rest[end - 1] == '\\')
    end = std::min(rest.find('"', end + 1), rest.size());
  for (bool bytes = !quoted && bytes_of_text(rest.substr(0, end)); bytes && end < rest.size();) {
    const std::size_t next = rest.find_first_not_of(" \t", end),
                      after = std::min(rest.find_first_of(" \t", next), rest.size());
    bytes = next != std::string_view::npos && bytes_of_text(rest.substr(next, after - next));
    if (bytes) end = after;
  }
  const std::string_view value = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  const auto characters = quoted && value.find('\\') != std::string_view::npos ? bytes_of_literal(value) : std::nullopt;
  return characters ? std::string(characters->begin(), characters->end()) : std::string(value);
}

struct Pairs {
  std::string_view before{};  ///< what stands before the first
  NamedFields fields{};
};

/// The time since 1970 after the fields of the line protocol of InfluxDB.
void add_time_at_end(std::string_view rest, NamedFields& fields) {
  constexpr std::size_t kFewestDigits = 10;
  const std::string_view digits = stl::trim(rest);
  if (!fields.empty() && digits.size() >= kFewestDigits && std::ranges::all_of(digits, stl::is_digit))
    fields.push_back({.name = "time", .value = std::string(digits)});
}

Pairs pairs_of(std::string_view line) {
  Pairs pairs;
  std::string_view rest = line;
  while (true) {
    const std::size_t equals = rest.find('=');
    if (equals == std::string_view::npos) {
      add_time_at_end(rest, pairs.fields);
      return pairs;
    }
    std::size_t begin = equals;
    while (begin > 0 && is_of_name(rest[begin - 1])) --begin;
    if (pairs.fields.empty()) pairs.before = line.substr(0, static_cast<std::size_t>(rest.data() - line.data()) + begin);
    const std::string name(rest.substr(begin, equals - begin));
    rest.remove_prefix(equals + 1);
    const bool quoted = rest.starts_with('"');
    std::string value = take_value(rest);
    if (!name.empty()) pairs.fields.push_back({.name = name, .value = std::move(value), .quoted = quoted});
  }
}

/// The number of lines at the beginning whose pairs are so.
std::ptrdiff_t count_lines_that(std::string_view bytes, bool (*is_so)(const NamedFields& fields)) {
  constexpr std::size_t kFewest = 2;  // pairs of a line with a frame: `tx=0103` alone may stand in any log
  std::ptrdiff_t count = 0;
  for (const std::string_view line : Lines(beginning_of(bytes))) {
    if (stl::trim(line).starts_with('<')) continue;  // attributes of XML
    const Pairs pairs = pairs_of(line);
    count += pairs.fields.size() >= kFewest && is_so(pairs.fields);
  }
  return count;
}

}  // namespace

bool looks_like_key_values(std::string_view bytes) {
  return is_text(bytes) && (count_lines_that(bytes, has_frame) > 0 || count_lines_that(bytes, has_characters) > 0 ||
                            count_lines_that(bytes, has_base64) > 0);
}

Result<LineRecording> read_key_values(std::string_view bytes, const ReadingChoices& choices) {
  NamedFieldsReader reader;
  if (count_lines_that(bytes, has_characters) > 0)
    reader.take_characters();
  else if (count_lines_that(bytes, has_base64) > count_lines_that(bytes, has_frame))
    reader.take_base64();
  std::size_t number = 0;
  for (const std::string_view line : Lines(bytes, choices.stop)) {
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
