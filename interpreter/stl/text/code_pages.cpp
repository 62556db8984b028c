#include "interpreter/stl/text/code_pages.hpp"

#include <algorithm>
#include <array>

#include "interpreter/base/text/text.hpp"
#include "interpreter/stl/code_page_tables.hpp"

namespace s7200::stl {
namespace {

constexpr char16_t kUndefined = kReplacement;

std::uint8_t byte_in_page(std::string_view bytes, std::size_t index) { return static_cast<std::uint8_t>(bytes[index]); }

/// The character of the pair that a text begins with, kUndefined if it begins with none.
char16_t first_pair(std::string_view bytes, const CodePage& page) {
  if (bytes.size() < 2 || byte_in_page(bytes, 0) < kFirstLead || byte_in_page(bytes, 1) < kFirstTrail) return kUndefined;
  const int lead = byte_in_page(bytes, 0) - kFirstLead, trail = byte_in_page(bytes, 1) - kFirstTrail;
  const auto index = static_cast<std::size_t>(lead * kTrails + trail);
  return trail < kTrails && index < page.pairs.size() ? page.pairs[index] : kUndefined;
}

bool is_surrogate(char32_t unit, char32_t first) { return unit >= first && unit < first + 0x400; }
constexpr char32_t kHigh = 0xD800, kLow = 0xDC00, kBeyond = 0x10000;

std::string little_endian(char32_t unit) { return {static_cast<char>(unit & 0xFF), static_cast<char>(unit >> 8)}; }

}  // namespace

const CodePage* find_code_page(std::string_view name) {
  const auto found = std::ranges::find(kCodePages, name, &CodePage::name);
  return found == std::end(kCodePages) ? nullptr : &*found;
}

std::string to_utf8(std::string_view bytes, const CodePage& page) {
  std::string text;
  while (!bytes.empty()) {
    const std::uint8_t byte = byte_in_page(bytes, 0);
    const char16_t pair = first_pair(bytes, page);
    const char32_t character = byte < 0x80 ? byte : pair != kUndefined ? pair : page.single[byte - 0x80];
    text += to_utf8(character);
    bytes.remove_prefix(byte >= 0x80 && pair != kUndefined ? 2 : 1);
  }
  return text;
}

std::string from_character(char32_t character, const CodePage& page) {
  if (character < 0x80) return {static_cast<char>(character)};
  if (character == kUndefined) return {};
  if (const auto byte = std::ranges::find(page.single, character); byte != page.single.end())
    return {static_cast<char>(0x80 + (byte - page.single.begin()))};
  const auto pair = std::ranges::find(page.pairs, character);
  if (pair == page.pairs.end()) return {};
  const auto index = pair - page.pairs.begin();
  return {static_cast<char>(kFirstLead + index / kTrails), static_cast<char>(kFirstTrail + index % kTrails)};
}

std::string utf16_to_utf8(std::string_view bytes, ByteOrder order) {
  std::string text;
  const auto unit_at = [&](std::size_t index) -> char32_t {
    if (index + 1 >= bytes.size()) return kReplacement;
    const char32_t first = byte_in_page(bytes, index), second = byte_in_page(bytes, index + 1);
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

}  // namespace s7200::stl
