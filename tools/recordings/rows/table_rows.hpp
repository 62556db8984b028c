// Rows and fields of a table with separators.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/stop_token.hpp"

namespace s7200::tools {

struct TableRow {
  std::size_t number = 0;  ///< of its line, from 1
  std::string_view text{};
};

/// The lines of a text one after the other, with the empty ones. A line end right after an opening quotation mark is a
/// recorded character, as Logic 2 writes it. Nothing is copied. There are no more rows once `stop` is requested.
class TableRows {
 public:
  explicit TableRows(std::string_view text, StopToken stop = {}) : rest_(text), stop_(stop) {}

  /// The next row; nothing at the end.
  std::optional<TableRow> next();

 private:
  std::string_view rest_;
  StopToken stop_;
  std::size_t number_ = 1;
};

/// Fields may stand in quotation marks; two marks in such a field are one.
std::vector<std::string> fields_of(std::string_view row, char separator);

/// Splits a row into a list that exists already: one list for all rows saves its memory from row to row.
void take_fields(std::string_view row, char separator, std::vector<std::string>& fields);

}  // namespace s7200::tools
