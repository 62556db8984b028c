// Values of coils and registers as people read them.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace s7200::tools {

enum class ValueForm : std::uint8_t { HexAndDecimal, Hex, Unsigned, Signed, Bits, Unsigned32, Signed32, Float, Text };

struct ValueFormat {
  ValueForm form = ValueForm::HexAndDecimal;
  bool low_word_first = false;  ///< of the two registers of a value of 32 bits; Modbus does not say

  /// The number of registers that make a value; 0 for text, where all make one.
  std::size_t registers() const;
};

/// The forms by their names on the command line.
struct ValueFormName {
  std::string_view name;
  ValueForm form;
};
std::span<const ValueFormName> value_forms();

/// A line for each value. Registers that are left over after the last value of 32 bits are shown in hex.
std::vector<std::string> value_lines(std::span<const std::uint16_t> registers, const ValueFormat& format);

/// Bits from the first on, in groups of four: `1010 11`.
std::string bits_line(std::span<const std::uint16_t> bits);

/// The values as numbers, of the form text as a string; those left over are left out.
nlohmann::ordered_json values_json(std::span<const std::uint16_t> registers, const ValueFormat& format);

}  // namespace s7200::tools
