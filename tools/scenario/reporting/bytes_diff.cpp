#include "tools/scenario/reporting/bytes_diff.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/text/text.hpp"

namespace s7200::tools {
namespace {

std::string byte_text(const std::vector<BytePattern>& bytes, std::size_t i) {
  if (i >= bytes.size()) return "  ";
  return bytes[i] ? fmt::format("{:02x}", *bytes[i]) : "..";
}

bool differs(const std::vector<BytePattern>& expected, const std::vector<BytePattern>& found, std::size_t i) {
  if (i >= expected.size() || i >= found.size()) return true;
  return expected[i] && found[i] && *expected[i] != *found[i];
}

}  // namespace

std::string row_of(const std::vector<BytePattern>& bytes, std::size_t from, std::size_t to) {
  std::string row;
  for (std::size_t i = from; i < std::min(to, bytes.size()); ++i)
    row.append(i == from ? "" : " ").append(byte_text(bytes, i));
  return row;
}

std::string painted(std::string_view text, const char* paint, bool colour) {
  return colour ? fmt::format("\x1b[{}m{}\x1b[0m", paint, text) : std::string(text);
}

std::string bytes_diff(const std::vector<BytePattern>& expected, const std::vector<BytePattern>& found,
                       const std::string& indent, bool colour, std::string_view expected_name, std::string_view found_name) {
  const std::size_t width = std::max<std::size_t>(9, std::max(expected_name.size(), found_name.size()));
  const std::size_t length = std::max(expected.size(), found.size());
  std::string text;
  bool left_out = false;
  for (std::size_t from = 0; from < length; from += kBytesInARow) {
    const std::size_t to = std::min(from + kBytesInARow, length);
    std::string marks;
    for (std::size_t i = from; i < to; ++i) marks += differs(expected, found, i) ? "^^ " : "   ";
    marks = std::string(stl::trim_end(marks));
    if (marks.empty() && length > 2 * kBytesInARow) {
      if (!left_out) text += indent + "…\n";
      left_out = true;
      continue;
    }
    left_out = false;
    const std::string place = length > kBytesInARow ? fmt::format("{:>4}  ", from) : "";
    text += fmt::format("{}{:<{}} {}{}\n", indent, expected_name, width, place, row_of(expected, from, to));
    text += fmt::format("{}{:<{}} {}{}\n", indent, found_name, width, place, row_of(found, from, to));
    if (!marks.empty())
      text +=
          fmt::format("{}{:<{}} {}{}\n", indent, "", width, std::string(place.size(), ' '), painted(marks, kRed, colour));
  }
  return text;
}

}  // namespace s7200::tools
