#include "tools/recordings/rows/marked_bytes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <vector>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/recordings/fields/fields.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/rows/bare_cells.hpp"
#include "tools/recordings/rows/lines.hpp"
#include "tools/recordings/rows/notation.hpp"
#include "tools/recordings/scan.hpp"

namespace s7200::tools {
namespace {

/// A way to mark a byte, with all of its digits.
struct ByteMark {
  std::string_view before, after;
  int base;
  std::size_t digits;
};
constexpr std::array kByteMarks{
    ByteMark{"", "h", 16, 2},    ByteMark{"", "H", 16, 2},     ByteMark{"0", "h", 16, 2},     ByteMark{"0", "H", 16, 2},
    ByteMark{"$", "", 16, 2},    ByteMark{"&H", "", 16, 2},    ByteMark{"&h", "", 16, 2},     ByteMark{"16#", "", 16, 2},
    ByteMark{"#", "", 16, 2},    ByteMark{"B#16#", "", 16, 2}, ByteMark{"b#16#", "", 16, 2},  ByteMark{"\\x", "", 16, 2},
    ByteMark{"%", "", 16, 2},    ByteMark{"x", "", 16, 2},     ByteMark{"0b", "", 2, 8},      ByteMark{"2#", "", 2, 8},
    ByteMark{"H'", "'", 16, 2},  ByteMark{"h'", "'", 16, 2},   ByteMark{"H'", "", 16, 2},     ByteMark{"h'", "", 16, 2},
    ByteMark{"X'", "'", 16, 2},  ByteMark{"x'", "'", 16, 2},   ByteMark{"8'h", "", 16, 2},    ByteMark{"8'H", "", 16, 2},
    ByteMark{"'h", "", 16, 2},   ByteMark{"H#", "", 16, 2},    ByteMark{"h#", "", 16, 2},     ByteMark{"B'", "'", 2, 8},
    ByteMark{"8'b", "", 2, 8},   ByteMark{"0x", "U", 16, 2},   ByteMark{"0x", "u", 16, 2},    ByteMark{"", "", 2, 8},
    ByteMark{"'0x", "'", 16, 2}, ByteMark{"'", "'", 16, 2},    ByteMark{"\"0x", "\"", 16, 2}, ByteMark{"\"", "\"", 16, 2},
};

/// Marks that a mark may stand beside: an assembler writes 0C4h next to 01h.
bool may_stand_beside(const ByteMark& mark, const ByteMark& other) {
  return mark.after == other.after && (mark.after == "h" || mark.after == "H") && mark.digits == other.digits;
}

struct PlainSign {
  std::string_view sign, plain;
};
/// A dash before a blank only divides: `01 \u2013 03`. The first row that fits is the one.
constexpr std::array kPlainSigns{
    PlainSign{"\u2013 ", ""},  PlainSign{"\u2014 ", ""},  PlainSign{"\u2013", "-"},  PlainSign{"\u2014", "-"},
    PlainSign{"\u2212", "-"},  PlainSign{"\u00A0", " "},  PlainSign{"\u2009", " "},  PlainSign{"\u202F", " "},
    PlainSign{"\u201C", "\""}, PlainSign{"\u201D", "\""}, PlainSign{"\u201E", "\""}, PlainSign{"\u201F", "\""},
    PlainSign{"\u00AB", "\""}, PlainSign{"\u00BB", "\""}, PlainSign{"\u2018", "\""}, PlainSign{"\u2019", "\""},
    PlainSign{"`", " "},       PlainSign{"\u25A0", " "},  PlainSign{"\u25A1", " "},  PlainSign{"\u25C6", " "},
    PlainSign{"\u25C7", " "},  PlainSign{"\u25CB", " "},  PlainSign{"\u25CF", " "}};

std::optional<std::uint8_t> byte_of(std::string_view word, const ByteMark& mark) {
  if (word.size() != mark.before.size() + mark.digits + mark.after.size()) return {};
  if (!word.starts_with(mark.before) || !word.ends_with(mark.after)) return {};
  const std::string_view digits = word.substr(mark.before.size(), mark.digits);
  std::uint8_t byte = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), byte, mark.base);
  return error == std::errc{} && end == digits.data() + digits.size() ? std::optional(byte) : std::nullopt;
}

/// The byte of a word in that notation, or in one that stands beside it.
std::optional<std::uint8_t> byte_in_marks(std::string_view word, const ByteMark& mark) {
  if (const auto byte = byte_of(word, mark)) return byte;
  for (const ByteMark& other : kByteMarks)
    if (may_stand_beside(mark, other))
      if (const auto byte = byte_of(word, other)) return byte;
  return {};
}

bool is_between_words(char c) { return std::string_view(" \t,;[]()<>").find(c) != std::string_view::npos; }

/// The signs that begin an escape without a blank before it: `\x0B\x03` and `%0B%03` are two words each.
bool begins_escape(char c) { return c == '\\' || c == '%'; }

/// Calls `see` with each word of a line. An escape begins a word.
template <typename See>
void for_each_word(std::string_view line, See see) {
  for (std::size_t begin = 0; begin < line.size();) {
    std::size_t end = begin;
    while (end < line.size() && !is_between_words(line[end]) && !(end > begin && begins_escape(line[end]))) ++end;
    if (end > begin) see(line.substr(begin, end - begin));
    begin = end < line.size() && begins_escape(line[end]) ? end : end + 1;
  }
}

/// The most bytes in that notation, one after the other, in a line.
std::size_t longest_run(std::string_view line, const ByteMark& mark) {
  std::size_t run = 0, longest = 0;
  for_each_word(line, [&](std::string_view word) {
    run = byte_in_marks(word, mark) ? run + 1 : 0;
    longest = std::max(longest, run);
  });
  return longest;
}

const ByteMark* mark_of(std::string_view text) {
  constexpr std::size_t kEnough = 4;
  for (const std::string_view line : Lines(beginning_of(text)))
    for (const ByteMark& mark : kByteMarks)
      if (longest_run(line, mark) >= kEnough) return &mark;
  return nullptr;
}

std::string with_plain_signs(std::string_view text) {
  std::string plain;
  plain.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = std::min(text.find_first_of("\xC2\xE2`"), text.size());
    plain.append(text.substr(0, length));
    text.remove_prefix(length);
    const auto sign = std::ranges::find_if(kPlainSigns, [&](const PlainSign& each) { return text.starts_with(each.sign); });
    plain.append(sign == kPlainSigns.end() ? text.substr(0, 1) : sign->plain);
    text.remove_prefix(sign == kPlainSigns.end() ? std::min<std::size_t>(1, text.size()) : sign->sign.size());
  }
  return plain;
}

std::string with_plain_bytes(std::string_view text, const ByteMark& mark) {
  std::string plain;
  plain.reserve(text.size());
  const char* copied = text.data();
  const auto copy_to = [&](const char* to) { plain.append(copied, to), copied = to; };
  for (const std::string_view line : Lines(text))
    for_each_word(line, [&](std::string_view word) {
      const auto byte = byte_in_marks(word, mark);
      if (!byte) return;
      copy_to(word.data());
      plain += fmt::format("{}{:02X}", !mark.before.empty() && begins_escape(mark.before.front()) ? " " : "", *byte);
      copied = word.data() + word.size();
    });
  copy_to(text.data() + text.size());
  return plain;
}

/// The text with the bytes of NSData alone: `{length = 8, bytes = 0x0103000a0002e409}`, as programs on Apple's systems log
/// it; nothing if there are none. Long ones have dots for a part of their bytes, and stay as they are.
std::optional<std::string> without_heads_of_nsdata(std::string_view text) {
  constexpr std::string_view kHead = "{length = ", kBytes = ", bytes = 0x";
  std::string plain;
  const char* copied = text.data();
  for (std::size_t at = text.find(kHead); at != std::string_view::npos; at = text.find(kHead, at + 1)) {
    Scan scan(text.substr(at + kHead.size()));
    const std::string_view count = scan.take_digits(4);
    if (!scan.take_word(kBytes)) continue;
    const std::string_view digits = scan.take_hex(std::string_view::npos);
    if (scan.next() != '}' || parse_decimal<std::size_t>(count) != digits.size() / 2) continue;
    plain.append(copied, text.data() + at).append(digits);
    copied = digits.data() + digits.size() + 1;
  }
  if (copied == text.data()) return {};
  return plain.append(copied, text.data() + text.size());
}

/// A mark of base64 before bytes, `b64:`, `base64=`, `base64 `, and how long it is. 0: there is none.
std::size_t length_of_mark_of_base64(std::string_view text) {
  for (const std::string_view name : {"base64", "b64", "BASE64", "B64", "Base64"}) {
    Scan scan(text);
    if (!scan.take_word(name)) continue;
    const bool divided = scan.take(":=") != '\0';
    return scan.skip(" ") > 0 || divided ? scan.at() : 0;
  }
  return 0;
}

/// Whether a word after such a mark is base64 and not of a sentence: `base64 encoded`.
bool may_be_base64(std::string_view word) { return word.size() > 2 && !std::ranges::all_of(word, stl::is_lower); }

/// The text with bytes in base64 in hex: `TX b64:EQMAawADdoc=`; nothing if there are none.
std::optional<std::string> without_base64(std::string_view text) {
  constexpr std::string_view kName = "64", kSigns = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/-_=";
  std::string plain;
  const char* copied = text.data();
  for (std::size_t at = text.find(kName); at != std::string_view::npos; at = text.find(kName, at + kName.size())) {
    std::size_t begin = at;
    while (begin > 0 && stl::is_letter(text[begin - 1])) --begin;
    const bool in_name = begin > 0 && is_word_sign(text[begin - 1]);
    const std::size_t mark = in_name ? 0 : length_of_mark_of_base64(text.substr(begin));
    const std::string_view rest = mark == 0 ? "" : text.substr(begin + mark);
    const std::string_view word = rest.substr(0, std::min(rest.find_first_not_of(kSigns), rest.size()));
    const auto bytes = may_be_base64(word) ? bytes_of_base64(std::string(word)) : std::nullopt;
    if (!bytes || (word.size() < rest.size() && !is_any_of(rest[word.size()], kAllBlanks))) continue;
    plain.append(copied, text.data() + begin);
    for (const std::uint8_t byte : *bytes) plain += fmt::format("{:02X} ", byte);
    copied = word.data() + word.size();
  }
  if (copied == text.data()) return {};
  return plain.append(copied, text.data() + text.size());
}

/// A byte that a line has in decimal and in hex: `11 (0x0B)`, `11(0x0B)`, `11 0x0B`, `0x0B (11)`.
struct ByteInBoth {
  std::size_t begin = 0, end = 0;  ///< place of both in the line
  std::uint8_t byte = 0;
};

/// The decimal number that ends there, in brackets or not. Its place is that of its first sign.
std::optional<ByteInBoth> decimal_before(std::string_view line, std::size_t end) {
  std::size_t last = end;
  if (last > 0 && line[last - 1] == '(') --last;
  while (last > 0 && line[last - 1] == ' ') --last;
  std::size_t begin = last;
  while (begin > 0 && stl::is_digit(line[begin - 1])) --begin;
  const auto byte = parse_decimal<std::uint8_t>(line.substr(begin, last - begin));
  if (!byte || (begin > 0 && is_word_sign(line[begin - 1]))) return {};
  return ByteInBoth{.begin = begin, .byte = *byte};
}

/// The decimal number in brackets that follows; its end is that of the brackets.
std::optional<ByteInBoth> decimal_after(std::string_view line, std::size_t begin) {
  Scan scan(line.substr(begin));
  scan.skip(" ");
  const std::string_view digits = scan.take("(") != '\0' ? scan.take_digits(3) : "";
  const auto byte = parse_decimal<std::uint8_t>(digits);
  if (!byte || scan.take(")") == '\0') return {};
  return ByteInBoth{.end = begin + scan.at(), .byte = *byte};
}

/// All bytes of a line that it has in both notations.
std::vector<ByteInBoth> bytes_in_both(std::string_view line) {
  std::vector<ByteInBoth> bytes;
  for (std::size_t at = line.find('x'); at != std::string_view::npos; at = line.find('x', at + 1)) {
    Scan scan(line.substr(at + 1));
    const std::string_view digits = scan.take_hex(3);
    if (at == 0 || line[at - 1] != '0' || digits.empty() || digits.size() > 2) continue;
    const auto byte = static_cast<std::uint8_t>(hex_number(digits));
    const std::size_t begin = at - 1, end = at + 1 + digits.size();
    const bool closes = begin > 0 && line[begin - 1] == '(' && end < line.size() && line[end] == ')';
    if (const auto before = decimal_before(line, begin); before && before->byte == byte)
      bytes.push_back({before->begin, end + (closes ? 1 : 0), byte});
    else if (const auto after = decimal_after(line, end); after && after->byte == byte)
      bytes.push_back({begin, after->end, byte});
  }
  return bytes;
}

/// Whether a line shows its bytes in both notations: several, one after the other, or a single one after its direction. Any
/// other number may be that of a register or an error.
bool has_bytes_in_both(std::string_view line, const std::vector<ByteInBoth>& bytes) {
  for (std::size_t i = 1; i < bytes.size(); ++i)
    if (line.substr(bytes[i - 1].end, bytes[i].begin - bytes[i - 1].end).find_first_not_of(" \t,;") !=
        std::string_view::npos)
      return false;
  if (bytes.size() != 1) return !bytes.empty();
  const std::string_view before = stl::trim(line.substr(0, bytes.front().begin));
  const std::string_view word = before.substr(before.find_last_of(" \t") + 1);
  return direction_of(word) != Direction::Unknown && stl::trim(line.substr(bytes.front().end)).empty();
}

/// The text with the bytes that it has in both notations in hex alone; nothing if there are none.
std::optional<std::string> without_decimal(std::string_view text) {
  std::string plain;
  const char* copied = text.data();
  for (const std::string_view line : Lines(text)) {
    const auto bytes = bytes_in_both(line);
    if (!has_bytes_in_both(line, bytes)) continue;
    for (const ByteInBoth& each : bytes) {
      plain.append(copied, line.data() + each.begin);
      plain += fmt::format("{:02X}", each.byte);
      copied = line.data() + each.end;
    }
  }
  if (copied == text.data()) return {};
  return plain.append(copied, text.data() + text.size());
}

}  // namespace

std::optional<std::uint8_t> marked_byte(std::string_view word) {
  for (const ByteMark& mark : kByteMarks) {
    const bool is_sure = !mark.before.empty() || mark.after == "h" || mark.after == "H";
    if (!is_sure || mark.base != 16 || is_any_of(mark.before.empty() ? ' ' : mark.before.front(), "'\"%#x0")) continue;
    if (const auto byte = byte_of(word, mark)) return byte;
  }
  return {};
}

std::optional<std::string> in_plain_hex(std::string_view text) {
  const bool has_signs = std::ranges::any_of(
      kPlainSigns, [&](const PlainSign& each) { return beginning_of(text).find(each.sign) != std::string_view::npos; });
  std::optional<std::string> plain = has_signs ? std::optional(with_plain_signs(text)) : std::nullopt;
  const auto so_far = [&] { return plain ? std::string_view(*plain) : text; };
  if (auto bytes = without_heads_of_nsdata(so_far())) plain = std::move(bytes);
  if (auto in_hex = without_base64(so_far())) plain = std::move(in_hex);
  if (auto cells = without_bare_cells(so_far())) plain = std::move(cells);
  if (auto in_hex = without_decimal(so_far())) plain = std::move(in_hex);
  if (const ByteMark* const mark = mark_of(so_far())) plain = with_plain_bytes(so_far(), *mark);
  return plain;
}

}  // namespace s7200::tools
