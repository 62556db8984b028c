// Tables in CSV (RFC 4180), as spreadsheets of all countries write them: where a comma is the decimal sign, the fields have
// semicolons or tabs between them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace s7200 {

/// The field in quotes where it has a comma, a quote or the end of a line in it.
inline std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) quoted.append(c == '"' ? 2 : 1, c);
  return quoted + '"';
}

/// What stands between the fields of a row: a semicolon or a tab if it has any outside of quotes, else a comma.
char csv_separator(std::string_view row);

/// The fields of a row, without quotes and blanks around them. Nothing if a quote is not closed.
std::optional<std::vector<std::string>> csv_fields(std::string_view row, char separator);

/// A number with a point, which has a decimal comma where the separator is something else.
std::string with_decimal_point(std::string number, char separator);

}  // namespace s7200
