#include "tools/views/state/ppi_text.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/text/text.hpp"
#include "interpreter/model/s7_pdu.hpp"

namespace s7200::tools {

std::string_view s7_error_name(std::uint16_t code) {
  switch (s7::Refusal{code}) {
    case s7::Refusal::BlockName:
      return "not the name of a block";
    case s7::Refusal::BlockType:
      return "no such type of block";
    case s7::Refusal::NoBlock:
      return "no such block";
    case s7::Refusal::NoBlockOfType:
      return "no block of this type";
    case s7::Refusal::OutOfTurn:
      return "no upload has been started";
    case s7::Refusal::Protected:
      return "the block is protected";
    default:
      break;
  }
  switch (code > UINT8_MAX ? code >> 8 : code) {
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

std::string s7_clock_text(std::span<const std::uint8_t> data) {
  const auto clock = s7::clock_in(data);
  if (!clock) return {};
  const auto& [year, month, day, hour, minute, second, milliseconds, weekday] = clock->todr;
  return fmt::format("{:02x}{:02x}-{:02x}-{:02x} {:02x}:{:02x}:{:02x}", clock->century, year, month, day, hour, minute,
                     second);
}

std::string s7_block_text(std::span<const std::uint8_t> name) {
  const auto block = s7::block_name_in(name);
  const std::string_view type = block ? s7::name_of_blocks(block->type) : std::string_view{};
  return type.empty() ? fmt::format("block '{}'", stl::printable(std::string(name.begin(), name.end())))
                      : fmt::format("{}{}", type, block->number);
}

std::string s7_identification_text(std::span<const std::uint8_t> bytes) {
  const std::string text(bytes.begin(), bytes.end());
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (text.size() != s7::kIdentificationBytes || !std::all_of(text.begin() + s7::kIdentificationName, text.end(), is_digit))
    return fmt::format("'{}'", stl::printable(text));
  const std::string name(stl::trim(std::string_view(text).substr(0, s7::kIdentificationName)));
  return fmt::format("{}, release {}.{}", stl::printable(name), text.substr(s7::kIdentificationName, 2),
                     text.substr(s7::kIdentificationName + 2));
}

}  // namespace s7200::tools
