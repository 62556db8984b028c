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

}  // namespace s7200::stl
