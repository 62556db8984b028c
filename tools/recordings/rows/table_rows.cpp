#include "tools/recordings/rows/table_rows.hpp"

#include <algorithm>

namespace s7200::tools {
namespace {

constexpr std::string_view kEndsOfRows = "\r\n", kSeparators = ",;\t|";

bool is_line_end(char c) { return kEndsOfRows.find(c) != std::string_view::npos; }

/// The length of a line end; CR LF is one line end.
std::size_t length_of_line_end(std::string_view text) { return text.starts_with("\r\n") ? 2 : 1; }

/// Whether `,"` stands in front of `at`; the caller knows whether the mark opens a field.
bool is_after_mark(std::string_view row, std::size_t at) {
  return at >= 2 && row[at - 1] == '"' && kSeparators.find(row[at - 2]) != std::string_view::npos;
}

}  // namespace

std::optional<TableRow> TableRows::next() {
  if (rest_.empty() || stop_.stop_requested()) return {};
  std::size_t end = 0, lines = 1;
  bool quoted = false;
  for (; end < rest_.size(); ++end) {
    if (rest_[end] == '"') quoted = !quoted;
    if (!is_line_end(rest_[end])) continue;
    if (!quoted || !is_after_mark(rest_, end)) break;
    ++lines;
    end += length_of_line_end(rest_.substr(end)) - 1;
  }
  const TableRow row{number_, rest_.substr(0, end)};
  number_ += lines;
  rest_.remove_prefix(std::min(rest_.size(), end + length_of_line_end(rest_.substr(end))));
  return row;
}

std::vector<std::string> fields_of(std::string_view row, char separator) {
  std::vector<std::string> fields;
  take_fields(row, separator, fields);
  return fields;
}

void take_fields(std::string_view row, char separator, std::vector<std::string>& fields) {
  std::size_t count = 0;
  const auto begin_field = [&] {
    if (count == fields.size()) fields.emplace_back();
    fields[count++].clear();
  };
  if (row.find('"') == std::string_view::npos) {
    for (std::size_t begin = 0, end = 0; end != std::string_view::npos; begin = end + 1) {
      end = row.find(separator, begin);
      if (count == fields.size()) fields.emplace_back();
      fields[count++] = row.substr(begin, end == std::string_view::npos ? end : end - begin);
    }
    return fields.resize(count);
  }
  begin_field();
  bool quoted = false;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const char c = row[i];
    if (c == '"' && quoted && i + 1 < row.size() && row[i + 1] == '"')
      fields[count - 1] += row[++i];
    else if (c == '"')
      quoted = !quoted;
    else if (c == separator && !quoted)
      begin_field();
    else
      fields[count - 1] += c;
  }
  fields.resize(count);
}

}  // namespace s7200::tools
