// The bits of special memory in words: one row for each, for all that shows them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace s7200 {

struct SpecialBit {
  std::uint8_t mask;  ///< of one bit
  std::string_view meaning;
};

/// The bits of a byte of special memory, by its place in the image; nothing for a byte without any.
std::span<const SpecialBit> special_bits(std::uint32_t at);

/// The bits that are set, as text: `SM1.0 zero, SM1.2 negative`.
std::string special_bits_text(std::uint32_t at, std::uint8_t value);

/// The meanings of the bits that are set, without their addresses: `zero, negative`.
std::string special_meanings_text(std::uint32_t at, std::uint8_t value);

}  // namespace s7200
