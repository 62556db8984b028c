// Modbus RTU requests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "serial_sim/line/frame.hpp"
#include "serial_sim/modbus/crc.hpp"
#include "serial_sim/modbus/functions.hpp"

namespace s7200::modbus {

/// Protocol data units: function code and data. Addresses count from 0, as on the wire.
/// Counts are not checked against the protocol's limits, because tests of a slave exceed them on purpose.
Bytes read_coils(std::uint16_t first, std::uint16_t count);
Bytes read_inputs(std::uint16_t first, std::uint16_t count);
Bytes read_holding_registers(std::uint16_t first, std::uint16_t count);
Bytes read_input_registers(std::uint16_t first, std::uint16_t count);
Bytes write_coil(std::uint16_t address, bool on);
Bytes write_register(std::uint16_t address, std::uint16_t value);
Bytes write_coils(std::uint16_t first, const std::vector<bool>& on);
Bytes write_registers(std::uint16_t first, std::span<const std::uint16_t> values);

Bytes read_exception_status();
Bytes diagnostics(std::uint16_t subfunction, std::span<const std::uint16_t> data);
Bytes report_slave_id();

/// Kind 6 are the registers of files (V1.1b3, 6.14). Makers have kinds of their own: kind 16#33 of Westinghouse is the
/// extended memory, by segment and offset, and counts bytes (NLAM-B58, addenda, 4.5).
inline constexpr std::uint8_t kFileReference = 6;
inline constexpr std::uint8_t kExtendedMemoryReference = 0x33;

/// A reference of functions 20 and 21: a place in a file.
struct Reference {
  std::uint8_t type = kFileReference;
  std::uint16_t file = 0;    ///< number of the file or segment
  std::uint16_t record = 0;  ///< number of the record or offset
  std::uint16_t count = 0;   ///< registers, or bytes
  Bytes data{};              ///< to be written

  bool operator==(const Reference&) const = default;
};

Bytes read_file_record(std::span<const Reference> references);
Bytes write_file_record(std::span<const Reference> references);

/// The references in the data after the byte count; one that is cut off is left out.
std::vector<Reference> references_of(std::span<const std::uint8_t> bytes, bool with_data);

/// A frame of station address, PDU and CRC.
Bytes rtu_frame(std::uint8_t station, std::span<const std::uint8_t> pdu);

/// Appends the CRC of the frame's bytes.
void append_crc(serial::Frame& frame);

}  // namespace s7200::modbus
