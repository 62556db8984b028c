// Rows of dumps: bytes in groups after an offset, as xxd, hexdump and od print them.
#pragma once

#include <optional>
#include <string_view>

#include "interpreter/base/bytes.hpp"

namespace s7200::tools {

/// A row of a dump; the last of od and hexdump has no bytes.
struct DumpRow {
  std::string_view offset{};
  std::size_t digits_of_group = 0;  ///< 2: a byte, 4: two of them, 3 and 6: the same in octal
  Bytes bytes{};
};

/// The row in a line: `00000000: 1103 006b  ...k`, `0000000 11 03 00 6b`, `0000000 001421 065400`. Nothing for any other.
/// Words without a colon before them have their low byte first, as on the computers that print them.
std::optional<DumpRow> dump_row(std::string_view line);

/// Whether an offset stands for that number, in hex, in decimal or, with seven digits, in octal.
bool is_offset_of(std::string_view digits, std::size_t number);

}  // namespace s7200::tools
