#include "serial_sim/line/frame.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "interpreter/base/text/numbers.hpp"

namespace s7200::serial {

Frame to_frame(std::span<const std::uint8_t> bytes) {
  Frame frame;
  frame.reserve(bytes.size());
  for (const std::uint8_t byte : bytes) frame.push_back({byte, false});
  return frame;
}

Bytes bytes_of(std::span<const FrameCharacter> frame) {
  Bytes bytes;
  bytes.reserve(frame.size());
  for (const FrameCharacter& character : frame) bytes.push_back(character.byte);
  return bytes;
}

bool has_wrong_parity(std::span<const FrameCharacter> frame) {
  return std::any_of(frame.begin(), frame.end(), [](const FrameCharacter& character) { return character.wrong_parity; });
}

namespace {

/// What stands between bytes: blanks, and the signs that other tools write there.
bool is_between(char c) { return std::string_view(" \t,;:-").find(c) != std::string_view::npos; }

}  // namespace

ParsedFrame parse_hex_frame(std::string_view text) {
  ParsedFrame parsed;
  const auto error = [&](std::size_t place, std::string message) {
    parsed.errors.push_back({place + 1, std::move(message)});
  };
  const auto at = [&](std::size_t place) { return place < text.size() ? text[place] : ' '; };

  std::size_t place = 0;
  while (place < text.size()) {
    const std::size_t first = place++;
    if (is_between(at(first)) && (first > 0 || at(first) == ' ' || at(first) == '\t')) continue;
    if (at(first) == '0' && (at(place) == 'x' || at(place) == 'X') && hex_digit(at(place + 1))) {  // `0x01`
      ++place;
      continue;
    }
    const auto high = hex_digit(at(first));
    const auto low = hex_digit(at(place));
    if (!high) {
      error(first, fmt::format("'{}' is not a hex digit", at(first)));
    } else if (is_between(at(place))) {
      error(first, fmt::format("a byte is two hex digits, 0{} for {}", at(first), at(first)));
    } else if (low) {
      ++place;
      const bool wrong_parity = at(place) == 'p' || at(place) == 'P';
      if (wrong_parity) ++place;
      if (parsed.frame.size() == kLongestRawFrame) {
        error(first, fmt::format("a frame has {} bytes at most", kLongestRawFrame));
        break;
      }
      parsed.frame.push_back({static_cast<std::uint8_t>(*high << 4 | *low), wrong_parity});
    }
  }
  if (parsed.frame.empty() && parsed.ok()) error(0, "a frame has one byte at least");
  return parsed;
}

std::string to_hex(std::span<const std::uint8_t> bytes) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  text.reserve(3 * bytes.size());
  for (const std::uint8_t byte : bytes) {
    if (!text.empty()) text += ' ';
    text += kDigits[byte >> 4];
    text += kDigits[byte & 0xF];
  }
  return text;
}

std::string to_hex(std::span<const FrameCharacter> frame) {
  std::string text;
  for (const FrameCharacter& character : frame) {
    if (!text.empty()) text += ' ';
    fmt::format_to(std::back_inserter(text), "{:02x}{}", character.byte, character.wrong_parity ? "p" : "");
  }
  return text;
}

}  // namespace s7200::serial
