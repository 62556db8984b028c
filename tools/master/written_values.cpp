#include "tools/master/written_values.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <stdexcept>
#include <string>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/master/words.hpp"

namespace s7200::tools {
namespace {

std::uint32_t float_bits(std::string_view text) {
  const auto value = parse_decimal<float>(text);
  if (!value || !std::isfinite(*value))
    throw std::invalid_argument(
        fmt::format("'{}' is not a number that a float can hold; write for example 1.5 or -2e3", stl::shortened(text)));
  return std::bit_cast<std::uint32_t>(*value);
}

void put_double(std::vector<std::uint16_t>& registers, std::uint32_t value, const ValueFormat& format) {
  const auto high = static_cast<std::uint16_t>(value >> 16), low = static_cast<std::uint16_t>(value & 0xFFFF);
  registers.push_back(format.low_word_first ? low : high);
  registers.push_back(format.low_word_first ? high : low);
}

}  // namespace

std::int64_t parse_number(std::string_view text, std::int64_t least, std::int64_t most, std::string_view what) {
  const auto value = parse_integer(text);
  if (!value)
    throw std::invalid_argument(
        fmt::format("{} '{}' is not a number; write for example 10 or 16#0A", what, stl::shortened(text)));
  if (*value < least || *value > most)
    throw std::invalid_argument(fmt::format("{} {} is not from {} to {}", what, text, least, most));
  return *value;
}

std::vector<std::uint16_t> parse_bits(std::string_view text) {
  std::vector<std::uint16_t> bits;
  for (const std::string& part : split_at_commas(std::string(text))) {
    if (part != "on" && part != "off" && part != "1" && part != "0")
      throw std::invalid_argument(
          fmt::format("'{}' is not the state of a coil; write on, off, 1 or 0", stl::shortened(part)));
    bits.push_back(part == "on" || part == "1" ? 1 : 0);
  }
  return bits;
}

std::vector<std::uint16_t> parse_registers(std::string_view text, const ValueFormat& format) {
  std::vector<std::uint16_t> registers;
  for (const std::string& part : split_at_commas(std::string(text))) {
    if (format.form == ValueForm::Float) {
      put_double(registers, float_bits(part), format);
    } else if (format.registers() == 2) {
      put_double(registers, static_cast<std::uint32_t>(parse_number(part, INT32_MIN, UINT32_MAX, "value")), format);
    } else if (part.find('.') != std::string_view::npos) {
      throw std::invalid_argument(fmt::format(
          "value {} is not a whole number; --as float writes it as a number of 32 bits into two registers", part));
    } else {
      registers.push_back(static_cast<std::uint16_t>(parse_number(part, INT16_MIN, UINT16_MAX, "value")));
    }
  }
  return registers;
}

}  // namespace s7200::tools
