// Bytes that were expected and bytes that were found, below each other.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/scenario/reading/text.hpp"

namespace s7200::tools {

/// What differs is marked. Rows of sixteen; of long ones only those around a difference. Every line begins with `indent`.
std::string bytes_diff(const std::vector<BytePattern>& expected, const std::vector<BytePattern>& found,
                       const std::string& indent, bool colour, std::string_view expected_name = "expected",
                       std::string_view found_name = "found");

/// `01 03 ..`: the bytes from … to, the last one not included.
std::string row_of(const std::vector<BytePattern>& bytes, std::size_t from, std::size_t to);

inline constexpr std::size_t kBytesInARow = 16;

/// In that colour, if any is wanted.
std::string painted(std::string_view text, const char* paint, bool colour);

inline constexpr const char *kRed = "1;31", *kGreen = "32", *kYellow = "33", *kBold = "1", *kDim = "2";

}  // namespace s7200::tools
