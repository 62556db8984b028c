#include "serial_sim/pc_protocol/command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/base/word_bytes.hpp"

namespace s7200::pc_protocol {
namespace {

constexpr std::uint8_t kCommandStart = 'g', kEnd = 'G', kZero = '0';
constexpr std::size_t kType = 1, kStation = 2, kAddress = 4, kDigits = 12, kCommandData = 14, kCheckCode = 30;

struct AreaRow {
  Area area;
  std::string_view name;
};
constexpr std::array kAreas{AreaRow{Area::I, "I"}, AreaRow{Area::Q, "Q"}, AreaRow{Area::M, "M"}, AreaRow{Area::V, "V"}};

std::optional<Area> area_of(std::uint16_t word) {
  const auto row =
      std::ranges::find_if(kAreas, [&](const AreaRow& r) { return static_cast<std::uint16_t>(r.area) == word; });
  return row == kAreas.end() ? std::nullopt : std::optional(row->area);
}

}  // namespace

Result<Address> parse_address(std::string_view text) {
  const std::string upper = stl::upper_case(text);
  for (const AreaRow& row : kAreas) {
    const std::string begin = fmt::format("{}B", row.name);
    if (!upper.starts_with(begin)) continue;
    const auto number = parse_decimal<std::uint16_t>(std::string_view(upper).substr(begin.size()));
    if (number) return Address{row.area, *number};
  }
  return trouble("'{}' is not a byte of I, Q, M or V; write for example VB100", stl::shortened(std::string(text)));
}

std::string_view area_name(Area area) {
  return std::ranges::find_if(kAreas, [&](const AreaRow& row) { return row.area == area; })->name;
}

std::string notation(const Address& address) { return fmt::format("{}B{}", area_name(address.area), address.number); }

std::uint8_t check_code(std::span<const std::uint8_t> characters) {
  std::uint8_t code = 0;
  for (const std::uint8_t character : characters) code ^= character;
  return code;
}

void append_digits(Bytes& to, std::span<const std::uint8_t> bytes) {
  constexpr std::string_view kHex = "0123456789ABCDEF";
  for (const std::uint8_t byte : bytes) {
    to.push_back(static_cast<std::uint8_t>(kHex[byte >> 4]));
    to.push_back(static_cast<std::uint8_t>(kHex[byte & 0x0F]));
  }
}

std::optional<Bytes> from_digits(std::span<const std::uint8_t> digits) {
  const auto is_digit = [](std::uint8_t c) { return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'F'); };
  if (digits.size() % 2 != 0 || !std::ranges::all_of(digits, is_digit)) return {};
  Bytes bytes;
  for (std::size_t place = 0; place < digits.size(); place += 2)
    bytes.push_back(static_cast<std::uint8_t>(*hex_digit(static_cast<char>(digits[place])) << 4 |
                                              *hex_digit(static_cast<char>(digits[place + 1]))));
  return bytes;
}

Bytes to_bytes(const Command& command) {
  assert(command.data.size() <= kMostBytes);
  const auto area = static_cast<std::uint16_t>(command.address.area);
  const std::uint16_t number = command.address.number;
  Bytes bytes{kCommandStart, static_cast<std::uint8_t>(command.type)};
  append_digits(bytes, std::array{command.station, high_byte(area), low_byte(area), high_byte(number), low_byte(number),
                                  static_cast<std::uint8_t>(2 * command.data.size())});
  append_digits(bytes, command.data);
  bytes.resize(kCheckCode, kZero);
  append_digits(bytes, std::array{check_code(std::span(bytes).subspan(kType))});
  bytes.push_back(kEnd);
  return bytes;
}

std::optional<Command> parse_command(std::span<const std::uint8_t> bytes) {
  if (bytes.size() != kCommandLength || bytes.front() != kCommandStart || bytes.back() != kEnd) return {};
  const auto type = static_cast<Type>(bytes[kType]);
  const auto decoded = from_digits(bytes.subspan(kStation, kCommandLength - 1 - kStation));
  if (!decoded || (type != Type::Read && type != Type::Write)) return {};
  const auto byte_place = [](std::size_t place) { return (place - kStation) / 2; };
  const std::uint8_t digits = (*decoded)[byte_place(kDigits)];
  const auto area = area_of(load16(&(*decoded)[byte_place(kAddress)]));
  const std::uint8_t code = check_code(bytes.subspan(kType, kCheckCode - kType));
  if (!area || decoded->back() != code) return {};
  Command command{type, decoded->front(), {*area, load16(&(*decoded)[byte_place(kAddress) + 2])}};
  if (type == Type::Read) return command;
  if (digits == 0 || digits % 2 != 0 || digits > 2 * kMostBytes) return {};
  const auto data = std::span(*decoded).subspan(byte_place(kCommandData), digits / 2U);
  command.data.assign(data.begin(), data.end());
  return command;
}

}  // namespace s7200::pc_protocol
