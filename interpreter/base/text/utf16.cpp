#include "interpreter/base/text/utf16.hpp"

#include "interpreter/base/text/text.hpp"

namespace s7200::stl {
namespace {

bool is_surrogate(char32_t unit, char32_t first) { return unit >= first && unit < first + 0x400; }
constexpr char32_t kHigh = 0xD800, kLow = 0xDC00, kBeyond = 0x10000;

std::string little_endian(char32_t unit) { return {static_cast<char>(unit & 0xFF), static_cast<char>(unit >> 8)}; }

char32_t byte_of(std::string_view bytes, std::size_t index) { return static_cast<std::uint8_t>(bytes[index]); }

}  // namespace

std::string utf16_to_utf8(std::string_view bytes, ByteOrder order) {
  std::string text;
  const auto unit_at = [&](std::size_t index) -> char32_t {
    if (index + 1 >= bytes.size()) return kReplacement;
    const char32_t first = byte_of(bytes, index), second = byte_of(bytes, index + 1);
    return order == ByteOrder::Little ? first | second << 8 : first << 8 | second;
  };
  for (std::size_t i = 0; i < bytes.size(); i += 2) {
    const char32_t unit = unit_at(i);
    const bool high = is_surrogate(unit, kHigh), pair = high && i + 2 < bytes.size() && is_surrogate(unit_at(i + 2), kLow);
    if (pair) {
      text += to_utf8(kBeyond + ((unit - kHigh) << 10) + (unit_at(i + 2) - kLow));
      i += 2;
    } else {
      text += to_utf8(high || is_surrogate(unit, kLow) ? kReplacement : unit);
    }
  }
  return text;
}

std::string to_utf16(char32_t character) {
  if (character < kBeyond) return little_endian(character);
  const char32_t beyond = character - kBeyond;
  return little_endian(kHigh + (beyond >> 10)) + little_endian(kLow + (beyond & 0x3FF));
}

std::optional<std::string> from_marked_utf16(std::string_view bytes) {
  if (bytes.starts_with("\xFF\xFE")) return utf16_to_utf8(bytes.substr(2), ByteOrder::Little);
  if (bytes.starts_with("\xFE\xFF")) return utf16_to_utf8(bytes.substr(2), ByteOrder::Big);
  return {};
}

}  // namespace s7200::stl
