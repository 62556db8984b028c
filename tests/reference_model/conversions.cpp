// Facts 6.9.
#include <array>
#include <cmath>

#include "tests/reference_model/instructions.hpp"
#include "tests/reference_model/values.hpp"

namespace s7200::reference {
namespace {

void bcd_to_integer(Machine& m) {
  const Place out = m.place(0, 2);
  const std::uint32_t word = read(out, 2);
  std::uint32_t result = 0;
  bool legal = true;
  for (const int shift : {12, 8, 4, 0}) {
    const std::uint32_t digit = (word >> shift) & 0xF;
    legal = legal && digit <= 9;
    result = 10 * result + digit;
  }
  set_flag(m, kNotBcd, !legal);
  if (legal) write(out, 2, result);
}

void integer_to_bcd(Machine& m) {
  const Place out = m.place(0, 2);
  const std::int32_t value = signed16(read(out, 2));
  const bool legal = value >= 0 && value <= 9999;
  set_flag(m, kNotBcd, !legal);
  if (!legal) return;
  const auto number = static_cast<std::uint32_t>(value);
  write(out, 2, number / 1000 << 12 | number / 100 % 10 << 8 | number / 10 % 10 << 4 | number % 10);
}

void integer_to_real(Machine& m) {
  const auto result = static_cast<float>(signed32(m.in(0, 4)));
  write(m.place(1, 4), 4, std::bit_cast<std::uint32_t>(result));
}

void truncate(Machine& m) {
  const double in = static_cast<double>(real(m.in(0, 4)));
  const Place out = m.place(1, 4);
  const bool legal = in > -2147483649.0 && in < 2147483648.0;  // false for a NaN
  set_flag(m, kOverflow, !legal);
  if (legal) write(out, 4, static_cast<std::uint32_t>(static_cast<std::int32_t>(in)));
}

/// To the nearest integer, a half away from zero.
void round(Machine& m) {
  const double in = static_cast<double>(real(m.in(0, 4)));
  const Place out = m.place(1, 4);
  const double nearest = in < 0 ? std::ceil(in - 0.5) : std::floor(in + 0.5);
  const bool legal = nearest >= -2147483648.0 && nearest < 2147483648.0;
  set_flag(m, kOverflow, !legal);
  if (legal) write(out, 4, static_cast<std::uint32_t>(static_cast<std::int32_t>(nearest)));
}

void byte_to_integer(Machine& m) {
  const std::uint32_t byte = m.in(0, 1);
  write(m.place(1, 2), 2, byte);
}

void integer_to_byte(Machine& m) {
  const std::uint32_t word = m.in(0, 2);
  const Place out = m.place(1, 1);
  set_flag(m, kOverflow, word > 255);
  if (word <= 255) write(out, 1, word);
}

void integer_to_double(Machine& m) {
  const std::uint32_t word = m.in(0, 2);
  write(m.place(1, 4), 4, word >= 0x8000 ? 0xFFFF'0000 | word : word);
}

void double_to_integer(Machine& m) {
  const std::int32_t value = signed32(m.in(0, 4));
  const Place out = m.place(1, 2);
  const bool fits = value >= -32768 && value <= 32767;
  set_flag(m, kOverflow, !fits);
  if (fits) write(out, 2, static_cast<std::uint32_t>(value) & 0xFFFF);
}

void decode(Machine& m) {
  const std::uint32_t number = m.in(0, 1) & 0xF;
  write(m.place(1, 2), 2, 1u << number);
}

void encode(Machine& m) {
  const std::uint32_t word = m.in(0, 2);
  const Place out = m.place(1, 1);
  std::uint32_t number = 0;
  while (number < 16 && !((word >> number) & 1)) ++number;
  if (word == 0) number = 0;
  write(out, 1, number);
}

void seven_segments(Machine& m) {
  static constexpr std::array<std::uint32_t, 16> kPattern{0x3F, 0x06, 0x5B, 0x4F, 0x66, 0x6D, 0x7D, 0x07,
                                                          0x7F, 0x67, 0x77, 0x7C, 0x39, 0x5E, 0x79, 0x71};
  const std::uint32_t digit = m.in(0, 1) & 0xF;
  write(m.place(1, 1), 1, kPattern[digit]);
}

// --- ASCII and hex ---

Place after(const Place& first, std::size_t n) { return {first.bytes, first.at + n}; }

/// Half a byte: digit 0 is the high nibble of the first byte.
std::uint32_t read_digit(const Place& first, std::size_t digit) {
  const std::uint32_t byte = read(after(first, digit / 2), 1);
  return digit % 2 == 0 ? byte >> 4 : byte & 0xF;
}

void write_digit(const Place& first, std::size_t digit, std::uint32_t value) {
  const Place place = after(first, digit / 2);
  const std::uint32_t byte = read(place, 1);
  write(place, 1, digit % 2 == 0 ? (byte & 0x0F) | value << 4 : (byte & 0xF0) | value);
}

/// 16 for a character that is not a digit.
std::uint32_t digit_of(std::uint32_t character) {
  if (character >= '0' && character <= '9') return character - '0';
  if (character >= 'A' && character <= 'F') return character - 'A' + 10;
  return 16;
}

void ascii_to_hex(Machine& m) {
  const Place in = m.place(0, 1), out = m.place(1, 1);
  const std::size_t length = m.in(2, 1);
  if (!holds(in, length) || !holds(out, (length + 1) / 2)) throw RunTimeError{0x91};
  bool illegal = false;
  for (std::size_t i = 0; i < length && !illegal; ++i) {
    const std::uint32_t digit = digit_of(read(after(in, i), 1));
    illegal = digit == 16;
    if (!illegal) write_digit(out, i, digit);
  }
  set_flag(m, kNotHex, illegal);
  m.spend_units(static_cast<std::uint32_t>(length));
}

void hex_to_ascii(Machine& m) {
  const Place in = m.place(0, 1), out = m.place(1, 1);
  const std::size_t length = m.in(2, 1);
  if (!holds(in, (length + 1) / 2) || !holds(out, length)) throw RunTimeError{0x91};
  for (std::size_t i = 0; i < length; ++i) {
    const std::uint32_t digit = read_digit(in, i);
    write(after(out, i), 1, digit < 10 ? '0' + digit : 'A' + digit - 10);
  }
  m.spend_units(static_cast<std::uint32_t>(length));
}

}  // namespace

void add_conversions(Instructions& all) {
  all["BCDI"] = {true, bcd_to_integer};
  all["IBCD"] = {true, integer_to_bcd};
  all["DTR"] = {true, integer_to_real};
  all["TRUNC"] = {true, truncate};
  all["ROUND"] = {true, round};
  all["BTI"] = {true, byte_to_integer};
  all["ITB"] = {true, integer_to_byte};
  all["ITD"] = {true, integer_to_double};
  all["DTI"] = {true, double_to_integer};
  all["DECO"] = {true, decode};
  all["ENCO"] = {true, encode};
  all["SEG"] = {true, seven_segments};
  all["ATH"] = {true, ascii_to_hex};
  all["HTA"] = {true, hex_to_ascii};
}

}  // namespace s7200::reference
