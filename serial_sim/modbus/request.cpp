#include "serial_sim/modbus/request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "interpreter/base/word_bytes.hpp"

namespace s7200::modbus {
namespace {

void add_word(Bytes& bytes, std::uint16_t word) {
  bytes.push_back(high_byte(word));
  bytes.push_back(low_byte(word));
}

Bytes pdu(Function function, std::uint16_t first, std::uint16_t second) {
  Bytes bytes{static_cast<std::uint8_t>(function)};
  add_word(bytes, first);
  add_word(bytes, second);
  return bytes;
}

}  // namespace

Bytes read_coils(std::uint16_t first, std::uint16_t count) { return pdu(Function::ReadCoils, first, count); }

Bytes read_inputs(std::uint16_t first, std::uint16_t count) { return pdu(Function::ReadInputs, first, count); }

Bytes read_holding_registers(std::uint16_t first, std::uint16_t count) {
  return pdu(Function::ReadHoldingRegisters, first, count);
}

Bytes read_input_registers(std::uint16_t first, std::uint16_t count) {
  return pdu(Function::ReadInputRegisters, first, count);
}

Bytes write_coil(std::uint16_t address, bool on) { return pdu(Function::WriteCoil, address, on ? 0xFF00 : 0x0000); }

Bytes write_register(std::uint16_t address, std::uint16_t value) { return pdu(Function::WriteRegister, address, value); }

Bytes write_coils(std::uint16_t first, const std::vector<bool>& on) {
  Bytes bytes = pdu(Function::WriteCoils, first, static_cast<std::uint16_t>(on.size()));
  Bytes packed((on.size() + 7) / 8);
  for (std::size_t coil = 0; coil < on.size(); ++coil) {
    if (on[coil]) packed[coil / 8] = static_cast<std::uint8_t>(packed[coil / 8] | 1U << coil % 8);
  }
  bytes.push_back(static_cast<std::uint8_t>(packed.size()));
  bytes.insert(bytes.end(), packed.begin(), packed.end());
  return bytes;
}

Bytes write_registers(std::uint16_t first, std::span<const std::uint16_t> values) {
  Bytes bytes = pdu(Function::WriteRegisters, first, static_cast<std::uint16_t>(values.size()));
  bytes.push_back(static_cast<std::uint8_t>(2 * values.size()));
  for (const std::uint16_t value : values) add_word(bytes, value);
  return bytes;
}

Bytes read_exception_status() { return {static_cast<std::uint8_t>(Function::ReadExceptionStatus)}; }

Bytes diagnostics(std::uint16_t subfunction, std::span<const std::uint16_t> data) {
  Bytes bytes{static_cast<std::uint8_t>(Function::Diagnostics)};
  add_word(bytes, subfunction);
  for (const std::uint16_t word : data) add_word(bytes, word);
  return bytes;
}

Bytes report_slave_id() { return {static_cast<std::uint8_t>(Function::ReportSlaveId)}; }

namespace {

Bytes file_request(Function function, std::span<const Reference> references) {
  Bytes bytes{static_cast<std::uint8_t>(function), 0};
  for (const Reference& reference : references) {
    bytes.push_back(reference.type);
    add_word(bytes, reference.file);
    add_word(bytes, reference.record);
    add_word(bytes, reference.count);
    bytes.insert(bytes.end(), reference.data.begin(), reference.data.end());
  }
  bytes[1] = static_cast<std::uint8_t>(bytes.size() - 2);
  return bytes;
}

}  // namespace

Bytes read_file_record(std::span<const Reference> references) { return file_request(Function::ReadFileRecord, references); }

Bytes write_file_record(std::span<const Reference> references) {
  return file_request(Function::WriteFileRecord, references);
}

std::vector<Reference> references_of(std::span<const std::uint8_t> bytes, bool with_data) {
  constexpr std::size_t kHead = 7;
  std::vector<Reference> references;
  while (bytes.size() >= kHead) {
    Reference reference{
        .type = bytes[0], .file = load16(&bytes[1]), .record = load16(&bytes[3]), .count = load16(&bytes[5])};
    bytes = bytes.subspan(kHead);
    if (with_data) {
      const std::size_t size = std::size_t{reference.count} * (reference.type == kFileReference ? 2 : 1);
      if (size > bytes.size()) break;
      reference.data.assign(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
      bytes = bytes.subspan(size);
    }
    references.push_back(std::move(reference));
  }
  return references;
}

Bytes rtu_frame(std::uint8_t station, std::span<const std::uint8_t> pdu) {
  Bytes frame;
  frame.reserve(pdu.size() + 3);
  frame.push_back(station);
  frame.insert(frame.end(), pdu.begin(), pdu.end());
  add_crc(frame);
  return frame;
}

void append_crc(serial::Frame& frame) {
  Bytes bytes = serial::bytes_of(frame);
  add_crc(bytes);
  for (std::size_t i = frame.size(); i < bytes.size(); ++i) frame.push_back({bytes[i], false});
}

}  // namespace s7200::modbus
