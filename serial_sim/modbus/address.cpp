#include "serial_sim/modbus/address.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "interpreter/base/text/text.hpp"

namespace s7200::modbus {
namespace {

using F = Function;

constexpr std::array kAreas{
    AreaRow{Area::Coils, "coils", "coil", 0, true, F::ReadCoils, F::WriteCoil, F::WriteCoils},
    AreaRow{Area::Inputs, "inputs", "input", 10000, true, F::ReadInputs, {}, {}},
    AreaRow{Area::InputRegisters, "input-registers", "input register", 30000, false, F::ReadInputRegisters, {}, {}},
    AreaRow{Area::HoldingRegisters, "holding", "holding register", 40000, false, F::ReadHoldingRegisters, F::WriteRegister,
            F::WriteRegisters},
};

constexpr std::uint32_t kInArea = 9999;
constexpr std::uint32_t kAllHolding = 400000;  // the base of the notation with 6 digits
constexpr std::uint32_t kAddresses = 65536;

std::string known_ranges() {
  std::string text;
  for (const AreaRow& row : kAreas)
    text += fmt::format("{:05} to {:05} {}s, ", row.base + 1, row.base + kInArea, row.singular);
  return text + fmt::format("{} to {} all holding registers", kAllHolding + 1, kAllHolding + kAddresses);
}

}  // namespace

std::span<const AreaRow> areas() { return kAreas; }

const AreaRow& row_of(Area area) { return kAreas[static_cast<std::size_t>(area)]; }

Result<DataAddress> parse_address(std::string_view digits) {
  const bool only_digits = std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (!only_digits || digits.size() < 5 || digits.size() > 6)
    return trouble("'{}' is not an address of 5 or 6 digits: {}", stl::shortened(digits), known_ranges());
  std::uint32_t number = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (number > kAllHolding && number <= kAllHolding + kAddresses)
    return DataAddress{Area::HoldingRegisters, static_cast<std::uint16_t>(number - kAllHolding - 1)};
  for (const AreaRow& row : kAreas) {
    if (number == row.base || (row.area == Area::HoldingRegisters && number == kAllHolding))
      return trouble("there is no {} {}: this notation counts from 1, the first is {:0{}}", row.singular, digits, number + 1,
                     digits.size());
    if (number > row.base && number <= row.base + kInArea)
      return DataAddress{row.area, static_cast<std::uint16_t>(number - row.base - 1)};
  }
  return trouble("{} is in no area: {}", digits, known_ranges());
}

std::string notation(const DataAddress& address) {
  const std::uint32_t number = address.address + 1U;
  if (number <= kInArea) return fmt::format("{:05}", row_of(address.area).base + number);
  return address.area == Area::HoldingRegisters ? fmt::format("{}", kAllHolding + number) : std::string();
}

}  // namespace s7200::modbus
