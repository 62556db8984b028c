// Takes a line of a log apart, from its beginning on.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string_view>

#include "interpreter/base/bytes.hpp"
#include "interpreter/base/text/text.hpp"

namespace s7200::tools {

inline constexpr std::string_view kAllBlanks = " \t\n\v\f\r";

/// Whether `c` is in a short list; std::string_view::find is made for long ones.
inline bool is_any_of(char c, std::string_view list) {
  for (const char each : list)
    if (each == c) return true;
  return false;
}
inline bool is_hex_digit(char c) { return stl::is_digit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F'); }
inline bool is_word_sign(char c) { return stl::is_digit(c) || stl::is_letter(c) || c == '_'; }

inline std::uint8_t value_of_digit(char digit) {
  return static_cast<std::uint8_t>(stl::is_digit(digit) ? digit - '0' : (digit | 0x20) - 'a' + 10);
}

/// The number of digits that fit in 64 bits.
inline std::int64_t decimal_number(std::string_view digits) {
  std::int64_t number = 0;
  for (const char digit : digits) number = 10 * number + value_of_digit(digit);
  return number;
}
inline std::size_t hex_number(std::string_view digits) {
  std::size_t number = 0;
  for (const char digit : digits) number = number << 4 | value_of_digit(digit);
  return number;
}

/// The most characters in front of the bytes of a line.
inline constexpr std::size_t kLongestHead = 256;

/// Takes parts off the beginning of a text, no further than a head goes.
class Scan {
 public:
  explicit Scan(std::string_view text) : text_(text.substr(0, kLongestHead)) {}

  std::size_t at() const { return at_; }
  void go_back_to(std::size_t at) { at_ = at; }
  char next() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  bool at_end() const { return at_ == text_.size(); }

  /// Takes the next character and returns it, or 0 if it is not one of `any`.
  char take(std::string_view any) {
    const char c = next();
    if (c == '\0' || !is_any_of(c, any)) return '\0';
    ++at_;
    return c;
  }
  bool take_word(std::string_view word) {
    const bool found = text_.substr(at_).starts_with(word);
    at_ += found ? word.size() : 0;
    return found;
  }
  /// Skips characters of `any` and returns their number.
  std::size_t skip(std::string_view any, std::size_t most = kLongestHead) {
    return take_while([any](char c) { return is_any_of(c, any); }, most).size();
  }
  std::string_view take_digits(std::size_t most) { return take_while(stl::is_digit, most); }
  std::string_view take_hex(std::size_t most) { return take_while(is_hex_digit, most); }

  template <class Fits>
  std::string_view take_while(Fits fits, std::size_t most = kLongestHead) {
    const std::size_t begin = at_, end = begin + std::min(most, text_.size() - begin);
    while (at_ < end && fits(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }
  std::string_view since(std::size_t begin) const { return text_.substr(begin, at_ - begin); }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
};

/// Takes the pairs of digits of a row of a dump, 16 of them at most, with a blank between, or two in the middle of the row.
inline Bytes take_row(Scan& scan) {
  constexpr std::size_t kFullRow = 16;
  Bytes bytes;
  while (bytes.size() < kFullRow) {
    const std::string_view pair = scan.take_hex(3);
    if (pair.size() != 2) break;
    bytes.push_back(static_cast<std::uint8_t>(hex_number(pair)));
    const std::size_t blanks = scan.skip(" ");
    if (blanks == 0 || blanks > (bytes.size() == kFullRow / 2 ? 2U : 1U)) break;
  }
  return bytes;
}

}  // namespace s7200::tools
