#include "tools/session/words/frame_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "serial_sim/modbus/address.hpp"
#include "serial_sim/modbus/request.hpp"
#include "tools/session/words/words.hpp"
#include "tools/views/text_frame.hpp"

namespace s7200::tools {
namespace {

using modbus::Area;

constexpr std::string_view kNamed =
    "read ADDRESS[:COUNT] or write ADDRESS=VALUE[,VALUE…], each with 'station n' after it or without, for example: read "
    "40011:2, write 00003=on station 4";

/// The parts of a text; an empty one too.
std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

Result<Bytes> read_request(const std::string& what) {
  const std::vector<std::string> parts = split(what, ':');
  const auto address = modbus::parse_address(parts[0]);
  if (!address) return address.trouble();
  const auto count = parts.size() == 2 ? parse_decimal<std::uint16_t>(parts[1]) : std::optional<std::uint16_t>(1);
  if (!count || *count == 0 || parts.size() > 2) return trouble("expected {}", kNamed);
  switch (address->area) {
    case Area::Coils:
      return modbus::read_coils(address->address, *count);
    case Area::Inputs:
      return modbus::read_inputs(address->address, *count);
    case Area::InputRegisters:
      return modbus::read_input_registers(address->address, *count);
    case Area::HoldingRegisters:
      return modbus::read_holding_registers(address->address, *count);
  }
  return std::nullopt;
}

/// `on`, `1`, `-5`, `16#1234`
std::optional<std::uint16_t> value_of(const std::string& text, bool bit) {
  const std::string word = stl::lower_case(text);
  if (bit && (word == "on" || word == "off")) return static_cast<std::uint16_t>(word == "on");
  const auto number = parse_integer(word);
  const std::int64_t least = bit ? 0 : -0x8000, most = bit ? 1 : 0xFFFF;
  if (!number || *number < least || *number > most) return {};
  return static_cast<std::uint16_t>(*number);
}

Result<Bytes> write_request(const std::string& what) {
  const std::vector<std::string> parts = split(what, '=');
  const auto address = modbus::parse_address(parts[0]);
  if (!address) return address.trouble();
  if (parts.size() != 2) return trouble("expected {}", kNamed);
  const modbus::AreaRow& area = modbus::row_of(address->area);
  if (!area.write_one) return trouble("{} can only be read: it is an {}", parts[0], area.singular);
  std::vector<std::uint16_t> values;
  for (const std::string& text : split(parts[1], ',')) {
    const auto value = value_of(text, area.bits);
    if (!value) return trouble("'{}' is not a value of a {}", stl::shortened(text), area.singular);
    values.push_back(*value);
  }
  const std::vector<bool> bits(values.begin(), values.end());
  if (values.size() == 1)
    return area.bits ? modbus::write_coil(address->address, bits[0]) : modbus::write_register(address->address, values[0]);
  return area.bits ? modbus::write_coils(address->address, bits) : modbus::write_registers(address->address, values);
}

/// Of words that are neither hex nor a request: something in them belongs to a request; nothing if there is none.
std::string misplaced_word(const std::vector<std::string>& words) {
  const auto has = [&](std::string_view word) {
    return std::ranges::any_of(words, [&](const std::string& one) { return stl::lower_case(one) == word; });
  };
  if (has("read") || has("write")) return fmt::format("expected {}", kNamed);
  if (has("station"))
    return "'station n' goes with read and write; in hex the first byte is the station: 04 03 00 0a 00 01 crc";
  return has("crc") ? "crc comes last: 01 03 00 0a 00 01 crc" : "";
}

Result<serial::Frame> named_frame(std::vector<std::string> words, std::uint8_t station) {
  if (words.size() == 4 && stl::lower_case(words[2]) == "station") {
    const auto number = parse_decimal<std::uint8_t>(words[3]);
    if (!number) return trouble("'{}' is not the number of a station", stl::shortened(words[3]));
    station = *number;
    words.resize(2);
  }
  if (words.size() != 2) return trouble("expected {}", kNamed);
  const auto pdu = stl::lower_case(words[0]) == "read" ? read_request(words[1]) : write_request(words[1]);
  if (!pdu) return pdu.trouble();
  return serial::to_frame(modbus::rtu_frame(station, *pdu));
}

}  // namespace

Result<serial::Frame> parse_frame(const std::string& text, std::uint8_t station) {
  std::string_view bytes = stl::trim(text);
  const std::string lower = stl::lower_case(bytes);
  if (lower.starts_with("read ") || lower.starts_with("write ")) return named_frame(stl::split_words(bytes), station);
  const bool crc = lower.ends_with(" crc");
  if (crc) bytes = stl::trim(bytes.substr(0, bytes.size() - 4));
  serial::ParsedFrame parsed = parse_hex_or_quoted(bytes);
  const bool quoted = bytes.starts_with('\'') || bytes.starts_with('"');
  if (!parsed.ok()) {
    if (std::string why = quoted ? "" : misplaced_word(stl::split_words(bytes)); !why.empty())
      return Trouble{std::move(why)};
    return trouble("column {}: {}", parsed.errors[0].column, parsed.errors[0].message);
  }
  if (parsed.frame.empty()) return Trouble{"there is nothing to send"};
  if (crc) modbus::append_crc(parsed.frame);
  return parsed.frame;
}

}  // namespace s7200::tools
