#include "tools/views/ppi_text.hpp"

#include <fmt/format.h>

#include "interpreter/model/s7_pdu.hpp"

namespace s7200::tools {

std::string_view s7_error_name(std::uint8_t code) {
  switch (code) {
    case s7::kNotAllowed:
      return "not allowed";
    case s7::kOutside:
      return "outside the memory of this CPU";
    case s7::kWrongType:
      return "the type does not go with the area";
    case s7::kNoArea:
      return "no such area";
    case static_cast<std::uint16_t>(s7::Refusal::Unknown) >> 8:
      return "function not available";
    case static_cast<std::uint16_t>(s7::Refusal::TooLong) >> 8:
      return "the answer would be too long";
    case static_cast<std::uint16_t>(s7::Refusal::Malformed) >> 8:
      return "malformed request";
    default:
      return "unknown";
  }
}

/// As it comes: FF 09 00 0A 00 century year month day hour minute second milliseconds weekday, in BCD.
std::string s7_clock_text(std::span<const std::uint8_t> data) {
  constexpr std::size_t kLength = 14;
  if (data.size() < kLength) return {};
  return fmt::format("{:02x}{:02x}-{:02x}-{:02x} {:02x}:{:02x}:{:02x}", data[5], data[6], data[7], data[8], data[9],
                     data[10], data[11]);
}

}  // namespace s7200::tools
