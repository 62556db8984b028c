// Tables of logic analysers and sniffers: the first row names the columns.
#include <fmt/format.h>

#include <algorithm>

#include "tools/recordings/fields.hpp"

namespace s7200::tools {
namespace {

std::string_view next_line(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

char separator_of(std::string_view line) {
  for (const char c : {'\t', ';', ','})
    if (line.find(c) != std::string_view::npos) return c;
  return 0;
}

/// Fields may stand in quotation marks.
std::vector<std::string> fields_of(std::string_view line, char separator) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"')
      quoted = !quoted;
    else if (c == separator && !quoted)
      fields.emplace_back();
    else
      fields.back() += c;
  }
  return fields;
}

struct Columns {
  char separator = 0;
  std::optional<std::size_t> time{}, direction{}, data{}, error{};
  Time unit = kSecond;
};

bool contains(std::string text, std::initializer_list<std::string_view> words) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::ranges::any_of(words, [&](std::string_view word) { return text.find(word) != std::string::npos; });
}

Columns columns_of(std::string_view line) {
  Columns columns{.separator = separator_of(line)};
  if (columns.separator == 0) return columns;
  const auto names = fields_of(line, columns.separator);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!columns.time && contains(names[i], {"time", "start"})) {
      columns.time = i;
      if (contains(names[i], {"[ms]", "(ms)", "_ms"})) columns.unit = kMillisecond;
      if (contains(names[i], {"[us]", "(us)", "_us", "µs"})) columns.unit = kMicrosecond;
    } else if (!columns.direction && contains(names[i], {"dir", "side", "channel", "port", "name"})) {
      columns.direction = i;
    } else if (!columns.data && contains(names[i], {"data", "value", "hex", "bytes", "frame", "payload"})) {
      columns.data = i;
    } else if (!columns.error && contains(names[i], {"error"})) {
      columns.error = i;
    }
  }
  return columns;
}

/// A number in the column's unit, or a time as in a text.
std::optional<Time> time_of(const std::string& field, Time unit) {
  std::size_t used = 0;
  try {
    const long double number = std::stold(field, &used);
    if (field.find_first_not_of(" \t", used) == std::string::npos && number >= 0 && number < 1e9L)
      return static_cast<Time>(number * static_cast<long double>(unit) + 0.5L);
  } catch (const std::exception&) {
    // Not a number: a time of day, perhaps.
  }
  const auto time = leading_time(field);
  return time ? std::optional(time->time) : std::nullopt;
}

}  // namespace

bool looks_like_csv(std::string_view text) {
  const Columns columns = columns_of(next_line(text));
  return columns.time && columns.data;
}

std::optional<LineRecording> read_csv(std::string_view text, const ReadingChoices& choices, std::string& why) {
  constexpr Time kGap = 5 * kMillisecond;
  LineRecording recording{.form = "CSV"};
  const Columns columns = columns_of(next_line(text));
  bool characters = true;
  for (std::size_t number = 2; !text.empty(); ++number) {
    const std::string_view line = next_line(text);
    if (line.find_first_not_of(" \t,;") == std::string_view::npos) continue;
    const auto fields = fields_of(line, columns.separator);
    const auto field = [&](std::optional<std::size_t> column) {
      return column && *column < fields.size() ? fields[*column] : "";
    };
    const auto time = time_of(field(columns.time), columns.unit);
    const auto bytes = bytes_of_text(field(columns.data));
    if (!time || !bytes) {
      why = fmt::format("line {}: '{}' is not {}", number, !time ? field(columns.time) : field(columns.data),
                        !time ? "a time" : "bytes in hex");
      return {};
    }
    characters = characters && bytes->size() == 1;
    recording.frames.push_back({.at = *time,
                                .direction = direction_of(field(columns.direction)),
                                .bytes = *bytes,
                                .place = fmt::format("line {}", number)});
  }
  count_from_first(recording);
  if (characters) join_characters(recording, choices.gap == 0 ? kGap : choices.gap);
  return recording;
}

}  // namespace s7200::tools
