// Addresses of data as people write them: 00017, 10005, 30001, 40001, 400001.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "interpreter/base/result.hpp"
#include "serial_sim/modbus/functions.hpp"

namespace s7200::modbus {

enum class Area : std::uint8_t { Coils, Inputs, InputRegisters, HoldingRegisters };

/// The facts of an area. The functions that write are those of the areas that can be written only.
struct AreaRow {
  Area area;
  std::string_view word;      ///< on the command line: `holding`
  std::string_view singular;  ///< `holding register`
  std::uint32_t base;         ///< in the notation: the first address is base + 1, the last base + 9999
  bool bits;
  Function read;
  std::optional<Function> write_one, write_many;
};

std::span<const AreaRow> areas();
const AreaRow& row_of(Area area);

/// An object on the wire, where addresses count from 0.
struct DataAddress {
  Area area = Area::Coils;
  std::uint16_t address = 0;

  bool operator==(const DataAddress&) const = default;
};

/// Reads the notation of 5 digits, or 6 with a zero in front: 00001 to 09999 are coils, 10001 to 19999 inputs, 30001 to
/// 39999 input registers, 40001 to 49999 holding registers; 400001 to 465536 are all holding registers there can be. The
/// first of each area is address 0 on the wire. Trouble for anything else. A shorter number is not taken for a
/// coil, though only zeros are missing: it might be meant as an address on the wire.
Result<DataAddress> parse_address(std::string_view digits);

/// The address in the notation, as short as possible: 40001, 410000. Empty if the notation does not reach it.
std::string notation(const DataAddress& address);

}  // namespace s7200::modbus
