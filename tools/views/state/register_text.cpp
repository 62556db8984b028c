#include "tools/views/state/register_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

using Form = ValueForm;

constexpr std::array kForms{
    ValueFormName{"hex+decimal", Form::HexAndDecimal},
    ValueFormName{"hex", Form::Hex},
    ValueFormName{"unsigned", Form::Unsigned},
    ValueFormName{"signed", Form::Signed},
    ValueFormName{"bits", Form::Bits},
    ValueFormName{"unsigned32", Form::Unsigned32},
    ValueFormName{"signed32", Form::Signed32},
    ValueFormName{"float", Form::Float},
    ValueFormName{"text", Form::Text},
};

std::uint32_t get_double(std::span<const std::uint16_t> registers, const ValueFormat& format) {
  const std::uint32_t first = registers[0], second = registers[1];
  return format.low_word_first ? second << 16 | first : first << 16 | second;
}

std::string bits_of(std::uint16_t value) {
  return fmt::format("2#{:04b}_{:04b}_{:04b}_{:04b}", value >> 12, value >> 8 & 15, value >> 4 & 15, value & 15);
}

std::string characters(std::span<const std::uint16_t> registers) {
  std::string text;
  for (const std::uint16_t value : registers) {
    text += static_cast<char>(value >> 8);
    text += static_cast<char>(value & 0xFF);
  }
  return text;
}

/// The registers as a quoted text; characters that are not printable ASCII are $hh, as in STL.
std::string quoted(std::span<const std::uint16_t> registers) {
  std::string text = "'";
  for (const char c : characters(registers)) {
    const bool plain = c >= ' ' && c <= '~' && c != '\'' && c != '$';
    if (plain)
      text += c;
    else
      text += fmt::format("${:02X}", static_cast<unsigned char>(c));
  }
  return text + "'";
}

std::string value_text(std::span<const std::uint16_t> registers, const ValueFormat& format) {
  const std::uint16_t word = registers[0];
  const auto negative = static_cast<std::int16_t>(word);
  switch (format.form) {
    case Form::HexAndDecimal:
      return fmt::format("16#{:04X}  {:5}{}", word, word, negative < 0 ? fmt::format("  {:6}", negative) : "");
    case Form::Hex:
      return fmt::format("16#{:04X}", word);
    case Form::Unsigned:
      return fmt::format("{:5}", word);
    case Form::Signed:
      return fmt::format("{:6}", negative);
    case Form::Bits:
      return bits_of(word);
    case Form::Unsigned32:
      return fmt::format("{:10}", get_double(registers, format));
    case Form::Signed32:
      return fmt::format("{:11}", static_cast<std::int32_t>(get_double(registers, format)));
    case Form::Float:
      return fmt::format("{:12}", std::bit_cast<float>(get_double(registers, format)));
    case Form::Text:
      return quoted(registers);
  }
  return {};
}

nlohmann::ordered_json value_json(std::span<const std::uint16_t> registers, const ValueFormat& format) {
  switch (format.form) {
    case Form::Signed:
      return static_cast<std::int16_t>(registers[0]);
    case Form::Unsigned32:
      return get_double(registers, format);
    case Form::Signed32:
      return static_cast<std::int32_t>(get_double(registers, format));
    case Form::Float:
      return real_json(std::bit_cast<float>(get_double(registers, format)));
    default:
      return registers[0];
  }
}

}  // namespace

std::size_t ValueFormat::registers() const {
  switch (form) {
    case Form::Unsigned32:
    case Form::Signed32:
    case Form::Float:
      return 2;
    case Form::Text:
      return 0;
    default:
      return 1;
  }
}

std::span<const ValueFormName> value_forms() { return kForms; }

std::vector<std::string> value_lines(std::span<const std::uint16_t> registers, const ValueFormat& format) {
  std::vector<std::string> lines;
  const std::size_t size = format.registers() == 0 ? std::max<std::size_t>(registers.size(), 1) : format.registers();
  for (; registers.size() >= size; registers = registers.subspan(size))
    lines.push_back(value_text(registers.first(size), format));
  for (const std::uint16_t left : registers) lines.push_back(fmt::format("16#{:04X}", left));
  return lines;
}

std::string bits_line(std::span<const std::uint16_t> bits) {
  std::string text;
  for (std::size_t bit = 0; bit < bits.size(); ++bit) {
    if (bit > 0 && bit % 4 == 0) text += ' ';
    text += bits[bit] != 0 ? '1' : '0';
  }
  return text;
}

nlohmann::ordered_json values_json(std::span<const std::uint16_t> registers, const ValueFormat& format) {
  if (format.form == Form::Text) {
    const std::string text = characters(registers);
    // JSON is UTF-8: each byte becomes the character of that number.
    std::string encoded;
    for (const char c : text) encoded += stl::to_utf8(static_cast<unsigned char>(c));
    return encoded;
  }
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (; registers.size() >= format.registers(); registers = registers.subspan(format.registers()))
    json.push_back(value_json(registers, format));
  return json;
}

}  // namespace s7200::tools
