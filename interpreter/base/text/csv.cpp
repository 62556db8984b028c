#include "interpreter/base/text/csv.hpp"

#include <algorithm>

#include "interpreter/base/text/text.hpp"

namespace s7200 {

char csv_separator(std::string_view row) {
  bool quoted = false;
  for (const char c : row) {
    if (c == '"') quoted = !quoted;
    if (!quoted && (c == ';' || c == '\t')) return c;
  }
  return ',';
}

std::optional<std::vector<std::string>> csv_fields(std::string_view row, char separator) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (quoted && row[i] == '"' && i + 1 < row.size() && row[i + 1] == '"') {
      fields.back() += row[i++];
    } else if (row[i] == '"') {
      quoted = !quoted;
    } else if (row[i] == separator && !quoted) {
      fields.emplace_back();
    } else {
      fields.back() += row[i];
    }
  }
  if (quoted) return {};
  for (std::string& field : fields) field = std::string(stl::trim(field));
  return fields;
}

std::string with_decimal_point(std::string number, char separator) {
  if (separator != ',') std::ranges::replace(number, ',', '.');
  return number;
}

}  // namespace s7200
