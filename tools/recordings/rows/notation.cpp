#include "tools/recordings/rows/notation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/json/base64.hpp"
#include "tools/recordings/fields/fields.hpp"
#include "tools/recordings/rows/marked_bytes.hpp"

namespace s7200::tools {
namespace {

std::optional<Bytes> one(std::optional<std::uint8_t> byte) { return byte ? std::optional(Bytes{*byte}) : std::nullopt; }

/// The byte that all of `digits` are in that base.
std::optional<std::uint8_t> byte_in_base(std::string_view digits, int base) {
  std::uint8_t byte = 0;
  const char* const end = digits.data() + digits.size();
  const auto [stopped, error] = std::from_chars(digits.data(), end, byte, base);
  return error == std::errc{} && stopped == end && !digits.empty() ? std::optional(byte) : std::nullopt;
}

/// A character that is written twice, as in Logic and ESPHome: `18 (0X12)`, `'18' (0x12)`, `1 (0X1)`, `\r (0x0D)`
std::optional<Bytes> with_hex(std::string_view cell) {
  const std::size_t bracket = cell.rfind('(');
  if (bracket == std::string_view::npos || bracket == 0 || !cell.ends_with(')')) return {};
  const std::string hex = stl::upper_case(cell.substr(bracket, cell.size() - bracket - 1));
  return hex.starts_with("(0X") ? one(byte_in_base(std::string_view(hex).substr(3), 16)) : std::nullopt;
}

/// Binary: `0b00010010`, `0b0001 0010` with a gap in the middle, and `00010010` of sigrok.
std::optional<Bytes> binary(std::string_view cell) {
  const bool marked = cell.starts_with("0b");
  std::string digits(marked ? cell.substr(2) : cell);
  if (marked) std::erase(digits, ' ');
  return digits.size() == 8 ? one(byte_in_base(digits, 2)) : std::nullopt;
}

/// Octal: `001`, `344` of sigrok.
std::optional<Bytes> octal(std::string_view cell) { return cell.size() == 3 ? one(byte_in_base(cell, 8)) : std::nullopt; }

/// Decimal without leading zeros: `1`, `16`, `132`.
std::optional<Bytes> decimal(std::string_view cell) {
  return cell.size() > 1 && cell.front() == '0' ? std::nullopt : one(parse_decimal<std::uint8_t>(cell));
}

/// A character as sigrok and DSView write it: `[0D]` for one that cannot be printed, `U` for one that can.
std::optional<Bytes> bracketed(std::string_view cell) {
  if (cell.size() == 1 && cell.front() >= ' ' && cell.front() <= '~') return Bytes{static_cast<std::uint8_t>(cell.front())};
  const bool has_brackets = cell.size() == 4 && cell.front() == '[' && cell.back() == ']';
  return has_brackets ? one(byte_in_base(cell.substr(1, 2), 16)) : std::nullopt;
}

/// A character as Logic 1 writes it: `V`, `COMMA`, `' '`, `\r`, and `'18'` in decimal for one that cannot be printed; Logic
/// 2 writes the characters themselves.
std::optional<Bytes> characters(std::string_view cell) {
  if (cell == "COMMA") return Bytes{','};
  if (cell == "' '") return Bytes{' '};
  if (cell.size() == 1) return Bytes{static_cast<std::uint8_t>(cell.front())};
  if (cell.size() > 2 && cell.front() == '\'' && cell.back() == '\'') return decimal(cell.substr(1, cell.size() - 2));
  const auto escaped = cell.starts_with('\\') ? bytes_of_literal(cell) : std::nullopt;
  return escaped && escaped->size() == 1 ? escaped : std::nullopt;
}

/// Numbers with blanks or commas between them, each a byte in that base and without zeros that fill it up: `17 6 0 154`.
std::optional<Bytes> numbers(std::string_view cell, int base) {
  constexpr std::string_view kBetween = " \t,;";
  if (cell.size() > 2 && cell.front() == '[' && cell.back() == ']') cell = cell.substr(1, cell.size() - 2);
  Bytes bytes;
  for (std::size_t begin = cell.find_first_not_of(kBetween); begin != std::string_view::npos;) {
    const std::size_t end = std::min(cell.find_first_of(kBetween, begin), cell.size());
    const auto byte = byte_in_base(cell.substr(begin, end - begin), base);
    if (!byte) return {};
    bytes.push_back(*byte);
    begin = cell.find_first_not_of(kBetween, end);
  }
  return bytes.empty() ? std::nullopt : std::optional(std::move(bytes));
}

/// Bytes with a mark each: `02h 03h`, `$02`, `H'02'`.
std::optional<Bytes> marked(std::string_view cell) {
  Bytes bytes;
  for (const std::string& word : stl::split_words(cell)) {
    const auto byte = marked_byte(word);
    if (!byte) return {};
    bytes.push_back(*byte);
  }
  return bytes.empty() ? std::nullopt : std::optional(std::move(bytes));
}

constexpr Notation kHex{"hex", bytes_of_text};
constexpr Notation kDecimals{"decimal numbers", [](std::string_view cell) { return numbers(cell, 10); }};
constexpr Notation kShortHex{"hex numbers", [](std::string_view cell) { return numbers(cell, 16); }};

/// The first that reads all cells is theirs: `18 (0x12)` could be two bytes in hex, and `00010010` four.
constexpr std::array kNotations{
    Notation{"characters with hex", with_hex},
    Notation{"binary", binary},
    kHex,
    Notation{"hex with marks", marked},
    Notation{"decimal", decimal},
    Notation{"octal", octal},
    Notation{"characters", bracketed},
    Notation{"characters", characters},
    kDecimals,
    kShortHex,
};

constexpr std::string_view kEscapes = "abtnvfre0", kEscaped{"\a\b\t\n\v\f\r\x1b\0", 9};

bool is_octal(char c) { return c >= '0' && c <= '7'; }

/// Takes digits of the base off the text, `most` of them at most.
std::optional<std::uint8_t> take_number(std::string_view& text, int base, std::size_t most) {
  std::size_t length = 0;
  while (length < std::min(most, text.size()) && (base == 8 ? is_octal(text[length]) : hex_digit(text[length]).has_value()))
    ++length;
  const auto byte = byte_in_base(text.substr(0, length), base);
  text.remove_prefix(length);
  return byte;
}

/// Whether a spreadsheet has made a number of the digits of bytes: `1,03E+11`
bool is_rounded_number(std::string_view cell) {
  const std::size_t e = cell.find("E+");
  return e != std::string_view::npos && e > 1 && std::ranges::all_of(cell.substr(e + 2), stl::is_digit) &&
         std::ranges::all_of(cell.substr(0, e), [](char c) { return stl::is_digit(c) || c == ',' || c == '.'; });
}

}  // namespace

WrittenCharacter without_error(std::string_view cell) {
  for (const std::string_view error : {"(framing error & parity error)", "(framing error)", "(parity error)"})
    if (cell.size() > error.size() && cell.ends_with(error))
      return {.cell = stl::trim_end(cell.substr(0, cell.size() - error.size())), .damaged = true};
  return {.cell = cell};
}

std::optional<Bytes> bytes_of_literal(std::string_view text) {
  Bytes bytes;
  while (!text.empty()) {
    const char c = text.front();
    text.remove_prefix(1);
    if (c != '\\') {
      bytes.push_back(static_cast<std::uint8_t>(c));
      continue;
    }
    if (text.empty()) return {};
    const char escape = text.front();
    std::optional<std::uint8_t> byte;
    if (is_octal(escape)) {
      byte = take_number(text, 8, 3);
    } else {
      text.remove_prefix(1);
      const std::size_t known = kEscapes.find(escape);
      if (escape == 'x')
        byte = take_number(text, 16, 2);
      else if (escape == 'u' && text.starts_with("00"))  // a character beyond U+00FF is no byte
        text.remove_prefix(2), byte = take_number(text, 16, 2);
      else if (known != std::string_view::npos)
        byte = static_cast<std::uint8_t>(kEscaped[known]);
      else if (escape == '\\' || escape == '"' || escape == '\'')
        byte = static_cast<std::uint8_t>(escape);
    }
    if (!byte) return {};
    bytes.push_back(*byte);
  }
  return bytes;
}

std::optional<Bytes> in_latin_1(std::string_view text) {
  Bytes bytes;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto lead = static_cast<unsigned char>(text[i]);
    if (lead < 0x80) {
      bytes.push_back(lead);
    } else {
      if ((lead != 0xC2 && lead != 0xC3) || i + 1 == text.size()) return {};
      bytes.push_back(static_cast<std::uint8_t>((lead & 0x03) << 6 | (text[++i] & 0x3F)));
    }
  }
  return bytes;
}

std::optional<Bytes> bytes_of_base64(std::string text) {
  constexpr std::size_t kGroup = 4;
  std::ranges::replace(text, '-', '+');
  std::ranges::replace(text, '_', '/');
  while (text.size() % kGroup > 1) text += '=';
  auto bytes = from_base64(text);
  return bytes && !bytes->empty() ? std::move(bytes) : std::nullopt;
}

NotationFinder::NotationFinder() {
  for (const Notation& notation : kNotations) candidates_.push_back({.notation = &notation});
}

void NotationFinder::take(std::string_view cell, std::size_t line) {
  if (cells_ == 0) first_ = cell, first_line_ = line;
  only_digits_ = only_digits_ && cell.size() == 1 && stl::is_digit(cell.front());
  for (Candidate& candidate : candidates_) {
    if (candidate.read < cells_) continue;
    if (const auto bytes = candidate.notation->read(cell))
      ++candidate.read, candidate.characters &= bytes->size() == 1;
    else
      candidate.wrong = cell, candidate.line = line;
  }
  ++cells_;
}

const Notation* NotationFinder::other(const Notation& found) const {
  const auto hex = std::ranges::find(candidates_, kShortHex.name, [](const Candidate& each) { return each.notation->name; });
  return found.name == kDecimals.name && hex->read == cells_ ? hex->notation : nullptr;
}

bool NotationFinder::are_characters(const Notation& notation) const {
  return std::ranges::find(candidates_, &notation, &Candidate::notation)->characters;
}

Result<const Notation&> NotationFinder::found() const {
  if (cells_ > 1 && only_digits_)
    return trouble("line {}: '{}' may be a number or a character; write the column in hex", first_line_, first_);
  // If several notations read as many cells, the message names hex, which most tools write.
  const auto nearest = std::ranges::max_element(
      candidates_, {}, [](const Candidate& each) { return std::pair(each.read, each.notation->name == kHex.name); });
  const auto all = std::ranges::find(candidates_, cells_, &Candidate::read);
  if (all != candidates_.end()) return *all->notation;
  std::string why = fmt::format("line {}: '{}' is not bytes in {}", nearest->line, stl::shortened(nearest->wrong),
                                nearest->notation->name);
  if (is_rounded_number(nearest->wrong)) why += ": a spreadsheet has rounded it; give it the column as text, and save again";
  return Trouble{std::move(why)};
}

}  // namespace s7200::tools
