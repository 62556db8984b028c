#include "tools/recordings/rows/number_list.hpp"

#include <algorithm>

#include "tools/recordings/fields/fields.hpp"
#include "tools/recordings/scan.hpp"

namespace s7200::tools {
namespace {

constexpr std::string_view kSeparators = " \t,;", kOpening = "[{(<", kAfterLast = " \t,;]})>.";

/// The numbers of a list, from its end on to the first sign that is of no list.
struct Numbers {
  std::vector<std::string_view> texts{};
  std::size_t begin = 0;
  bool in_brackets = false;
};

Numbers numbers_at_end(std::string_view line) {
  constexpr std::size_t kMostDigits = 3;
  Numbers numbers;
  for (std::size_t end = line.find_last_not_of(kAfterLast) + 1; end > 0;) {
    std::size_t begin = end;
    while (begin > 0 && is_hex_digit(line[begin - 1])) --begin;
    const bool is_number = begin < end && end - begin <= kMostDigits;
    const char before = begin > 0 ? line[begin - 1] : ' ';
    if (!is_number || is_word_sign(before)) break;
    numbers.texts.push_back(line.substr(begin, end - begin));
    numbers.begin = begin;
    numbers.in_brackets = is_any_of(before, kOpening);
    const bool in_own_brackets = begin > 1 && before == '[' && line[begin - 2] == ']';    // `[011][003]`
    const bool after_dash = begin > 1 && before == '-' && is_hex_digit(line[begin - 2]);  // `1-3-0-196` of modbus_tk
    if (begin == 0 || !(is_any_of(before, kSeparators) || in_own_brackets || after_dash)) break;
    end = in_own_brackets ? begin - 2 : after_dash ? begin - 1 : line.find_last_not_of(kSeparators, begin - 1) + 1;
  }
  std::ranges::reverse(numbers.texts);
  return numbers;
}

std::optional<Bytes> in_decimal(const std::vector<std::string_view>& numbers) {
  Bytes bytes;
  for (const std::string_view number : numbers) {
    if (!std::ranges::all_of(number, stl::is_digit) || decimal_number(number) > 0xFF) return {};
    bytes.push_back(static_cast<std::uint8_t>(decimal_number(number)));
  }
  return bytes;
}

std::optional<Bytes> in_hex(const std::vector<std::string_view>& numbers) {
  Bytes bytes;
  for (const std::string_view number : numbers) {
    if (number.size() > 2) return {};
    bytes.push_back(static_cast<std::uint8_t>(hex_number(number)));
  }
  return bytes;
}

}  // namespace

std::optional<NumberList> number_list_at_end(std::string_view line) {
  constexpr std::size_t kFewest = 4;
  constexpr std::ptrdiff_t kFewestOdd = 2;
  const auto is_odd = [](std::string_view number) { return number.size() != 2; };
  const Numbers numbers = numbers_at_end(line);
  if (numbers.texts.size() < kFewest || std::ranges::count_if(numbers.texts, is_odd) < kFewestOdd) return {};
  const auto odd = std::ranges::find_if(numbers.texts, is_odd);
  const std::string_view before = stl::trim(line.substr(0, numbers.begin));
  const std::string_view word = before.substr(before.find_last_of(" \t") + 1);  // of `-> RX:`, whose arrow is of every line
  const bool names_direction = direction_of(before) != Direction::Unknown || direction_of(word) != Direction::Unknown;
  if (!numbers.in_brackets && !before.empty() && !names_direction) return {};
  if (is_any_of(word.empty() ? ' ' : word.back(), ",;") && direction_of(word) == Direction::Unknown)
    return {};  // `$GPRMC,1,2`
  NumberList list{.begin = numbers.begin, .odd = *odd};
  for (const auto& bytes : {in_hex(numbers.texts), in_decimal(numbers.texts)})
    if (bytes) list.readings.push_back({*bytes, false});
  if (numbers.in_brackets) std::ranges::reverse(list.readings);  // as languages write them
  return list.readings.empty() ? std::nullopt : std::optional(std::move(list));
}

}  // namespace s7200::tools
