// Bodies: conversions (facts 6.9).
//
// Not documented, modelled so:
// - ATH and HTA work character by character, which shows when IN and OUT overlap. [Vectors.ATH, Vectors.HTA]
// - ENCO writes the whole byte OUT: the number, at most 15. The manual only speaks of its low half (C233-01, 9-131).
//   [Vectors.ENCO]
// - ENCO of a word with no bit set gives 0. [Vectors.ENCO]
#pragma once

#include <bit>
#include <cmath>
#include <optional>

#include "interpreter/cpu/core.hpp"

namespace s7200::bodies {

/// BCDI: four BCD digits to an integer.
inline void from_bcd(Core& core, const Op& op) {
  const auto bcd = core.get<std::uint16_t>(op[0]);
  unsigned value = 0;
  for (int shift = 12; shift >= 0; shift -= 4) {
    const unsigned digit = (bcd >> shift) & 15u;
    if (digit > 9) return core.set_flags(kNotBcd, kNotBcd);
    value = value * 10 + digit;
  }
  core.put(op[0], static_cast<std::uint16_t>(value));
  core.set_flags(kNotBcd, 0);
}

/// IBCD: an integer of 0 to 9999 to BCD.
inline void to_bcd(Core& core, const Op& op) {
  const auto value = core.get<std::uint16_t>(op[0]);
  if (value > 9999) return core.set_flags(kNotBcd, kNotBcd);
  core.put(op[0],
           static_cast<std::uint16_t>(value / 1000 << 12 | value / 100 % 10 << 8 | value / 10 % 10 << 4 | value % 10));
  core.set_flags(kNotBcd, 0);
}

inline void integer_to_real(Core& core, const Op& op) { core.put(op[1], static_cast<float>(core.get<std::int32_t>(op[0]))); }

/// std::round of Windows makes 1 of 0.49999997: its sum is rounded itself, and in double it is exact.
inline float rounded(float real) {
  return static_cast<float>(std::trunc(static_cast<double>(real) + std::copysign(0.5, static_cast<double>(real))));
}

/// TRUNC: toward zero; ROUND: to the nearest. A value that does not fit sets SM1.1 and stores nothing.
/// Not documented, modelled so: ROUND takes a half away from zero. [Vectors.ROUND]
template <bool nearest>
void to_integer(Core& core, const Op& op) {
  const auto real = core.get<float>(op[0]);
  const float value = nearest ? rounded(real) : std::trunc(real);
  if (!(value >= -2147483648.0f && value < 2147483648.0f)) return core.set_flags(kOverflow, kOverflow);
  core.put(op[1], static_cast<std::int32_t>(value));
  core.set_flags(kOverflow, 0);
}

/// BTI, ITD: a byte has no sign, an integer has one.
template <class From, class To>
void widen(Core& core, const Op& op) {
  core.put(op[1], static_cast<To>(core.get<From>(op[0])));
}

/// ITB, DTI: a value that does not fit sets SM1.1 and stores nothing.
template <class From, class To>
void narrow(Core& core, const Op& op) {
  const auto value = core.get<From>(op[0]);
  const auto result = static_cast<To>(value);
  if (result != value) return core.set_flags(kOverflow, kOverflow);
  core.put(op[1], result);
  core.set_flags(kOverflow, 0);
}

inline void decode_bit(Core& core, const Op& op) {
  core.put(op[1], static_cast<std::uint16_t>(1u << (core.get<std::uint8_t>(op[0]) & 15)));
}

inline void encode_bit(Core& core, const Op& op) {
  const auto word = core.get<std::uint16_t>(op[0]);
  core.put(op[1], static_cast<std::uint8_t>(word == 0 ? 0 : std::countr_zero(word)));
}

/// Segments a (bit 0) to g (bit 6) of the digits 0 to F.
inline void seven_segments(Core& core, const Op& op) {
  static constexpr std::uint8_t kSegments[16] = {0x3F, 0x06, 0x5B, 0x4F, 0x66, 0x6D, 0x7D, 0x07,
                                                 0x7F, 0x67, 0x77, 0x7C, 0x39, 0x5E, 0x79, 0x71};
  core.put(op[1], kSegments[core.get<std::uint8_t>(op[0]) & 15]);
}

/// Digits are 0–9 and capital A–F (S7-200 manual C233-01, 9-135).
inline std::optional<std::uint8_t> hex_digit(std::uint8_t character) {
  if (character >= '0' && character <= '9') return static_cast<std::uint8_t>(character - '0');
  if (character >= 'A' && character <= 'F') return static_cast<std::uint8_t>(character - 'A' + 10);
  return {};
}

/// Whether the blocks of ATH and HTA are inside their areas; empty blocks are. If not, reports a range error.
inline bool hex_blocks_fit(Core& core, std::uint32_t characters, std::uint32_t digits, std::uint32_t length) {
  if (core.in_area(characters, length) && core.in_area(digits, (length + 1) / 2)) return true;
  core.run_error(RunError::OperandRange);
  return false;
}

/// ATH: converts LEN characters to digits, the first into a high half. An odd LEN leaves the low half of the last byte alone
/// (S7-200 manual C233-01, 9-135). The conversion ends at an illegal character (facts 9.1).
inline void ascii_to_hex(Core& core, const Op& op) {
  const std::uint32_t length = core.get<std::uint8_t>(op[2]);
  if (!hex_blocks_fit(core, op[0].at, op[1].at, length)) return;
  core.spend(op, length);
  for (std::uint32_t i = 0; i < length; ++i) {
    const auto digit = hex_digit(core.s.image[op[0].at + i]);
    if (!digit) return core.set_flags(kNotHex, kNotHex);
    std::uint8_t& byte = core.s.image[op[1].at + i / 2];
    byte = static_cast<std::uint8_t>(i % 2 == 0 ? (byte & 0x0F) | *digit << 4 : (byte & 0xF0) | *digit);
  }
  core.set_flags(kNotHex, 0);
}

/// HTA: converts LEN digits to characters.
inline void hex_to_ascii(Core& core, const Op& op) {
  const std::uint32_t length = core.get<std::uint8_t>(op[2]);
  if (!hex_blocks_fit(core, op[1].at, op[0].at, length)) return;
  core.spend(op, length);
  for (std::uint32_t i = 0; i < length; ++i) {
    const std::uint8_t byte = core.s.image[op[0].at + i / 2];
    core.s.image[op[1].at + i] = static_cast<std::uint8_t>("0123456789ABCDEF"[i % 2 == 0 ? byte >> 4 : byte & 15]);
  }
}

}  // namespace s7200::bodies
