#include "serial_sim/westinghouse/modbus_plc.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "interpreter/base/bytes.hpp"
#include "interpreter/base/word_bytes.hpp"
#include "serial_sim/modbus/crc.hpp"
#include "serial_sim/modbus/functions.hpp"
#include "serial_sim/westinghouse/messages/words.hpp"

namespace s7200::westinghouse {
namespace {

using modbus::Function;
using Model = ModbusSettings::Model;

constexpr std::uint8_t kIllegalFunction = 1, kIllegalAddress = 2, kIllegalQuantity = 3;
constexpr std::size_t kLongestFrame = 300;  // 125 registers with function 16 make 259 bytes
constexpr std::uint8_t kExtendedMemory = 0x33;
constexpr std::uint32_t kMemoryBytes = 0x20000, kWords = 0x10000;
constexpr unsigned kStatusRegister = 6;  // function 7 on NCMZ

constexpr std::uint8_t kOfPc503[]{1, 2, 3, 5, 6, 8, 15, 16};
constexpr std::uint8_t kOfPc1200[]{1, 2, 3, 4, 5, 6, 7, 8, 15, 16, 17, 20, 21};
constexpr std::uint8_t kOfPc2000[]{1, 2, 3, 4, 5, 6, 8, 16};
constexpr std::uint8_t kOfNcmz[]{1, 2, 3, 4, 5, 6, 7, 8, 16};
constexpr std::uint8_t kOfHppc[]{1, 2, 3, 4, 5, 6, 8, 15, 16};

/// A model and the functions that it supports; choice [M1] is made in supports().
struct ModelRow {
  Model model;
  std::string_view word;
  std::span<const std::uint8_t> functions;
};
constexpr std::array kModels{ModelRow{Model::Pc503, "pc503", kOfPc503},    ModelRow{Model::Pc1200, "pc1200", kOfPc1200},
                             ModelRow{Model::Pc1250, "pc1250", kOfPc1200}, ModelRow{Model::Pc2000, "pc2000", kOfPc2000},
                             ModelRow{Model::Ncmz, "ncmz", kOfNcmz},       ModelRow{Model::Hppc, "hppc", kOfHppc}};
static_assert(std::ranges::is_sorted(kModels, {}, &ModelRow::model), "the setting `plc` is a place among the words");

Bytes exception(std::span<const std::uint8_t> pdu, std::uint8_t code) {
  return {static_cast<std::uint8_t>(pdu[0] | modbus::kExceptionFlag), code};
}

Bytes begin_of(std::span<const std::uint8_t> pdu, std::size_t length) {
  return {pdu.begin(), pdu.begin() + static_cast<std::ptrdiff_t>(length)};
}

}  // namespace

void ModbusPlc::hear(const ReceivedCharacter& character) {
  damaged_ = damaged_ || character.framing_error || character.parity_error || frame_.size() == kLongestFrame;
  if (!damaged_) frame_.push_back(character.byte);
  const SerialFormat& line = settings_.line;
  wake_at(character.start + line.character_time() + line.half_bits(2 * line.bits() * settings_.silence / 10));
}

void ModbusPlc::wake(Time now) {
  wake_at(kNever);
  const Bytes frame = std::exchange(frame_, {});
  if (std::exchange(damaged_, false) || frame.size() < 4 || !modbus::crc_ok(frame)) return;
  const bool broadcast = frame[0] == modbus::kBroadcast;
  if (!broadcast && frame[0] != settings_.slave) return;
  if (broadcast && !carries_out_broadcast(frame[1])) return;
  Bytes reply = this->reply(std::span(frame).subspan(1, frame.size() - 3));
  if (broadcast || reply.empty()) return;
  reply.insert(reply.begin(), frame[0]);
  modbus::add_crc(reply);
  answer(std::move(reply), now);
}

void ModbusPlc::restart(Time) {
  frame_.clear();
  damaged_ = false;
  wake_at(kNever);
}

/// [M1] Section 4.1 gives function 7 to the HPPC, section 4.2.2, which the rows follow, to NCMZ.
bool ModbusPlc::supports(std::uint8_t function) const {
  const bool by_41 = settings_.function_7 == ModbusSettings::Function7::Section41;
  if (by_41 && function == static_cast<std::uint8_t>(Function::ReadExceptionStatus)) {
    if (settings_.plc == Model::Ncmz) return false;
    if (settings_.plc == Model::Hppc) return true;
  }
  return std::ranges::count(kModels[static_cast<std::size_t>(settings_.plc)].functions, function) != 0;
}

bool ModbusPlc::carries_out_broadcast(std::uint8_t function) const {
  switch (static_cast<Function>(function)) {
    case Function::WriteCoil:
    case Function::WriteRegister:
    case Function::WriteRegisters:
      return true;
    case Function::WriteCoils:
    case Function::WriteFileRecord:
      return settings_.broadcasts == ModbusSettings::Broadcasts::Writes;
    default:
      return false;
  }
}

Bytes ModbusPlc::reply(Data pdu) {
  if (!supports(pdu[0])) return exception(pdu, kIllegalFunction);
  switch (static_cast<Function>(pdu[0])) {
    case Function::ReadCoils:
    case Function::ReadInputs:
      return read_bits(pdu);
    case Function::ReadHoldingRegisters:
    case Function::ReadInputRegisters:
      return read_registers(pdu);
    case Function::WriteCoil:
      return write_coil(pdu);
    case Function::WriteRegister:
      return write_register(pdu);
    case Function::ReadExceptionStatus:
      return status(pdu);
    case Function::Diagnostics:
      return loopback(pdu);
    case Function::WriteCoils:
      return write_coils(pdu);
    case Function::WriteRegisters:
      return write_registers(pdu);
    case Function::ReportSlaveId:
      return slave_id(pdu);
    case Function::ReadFileRecord:
    case Function::WriteFileRecord:
      return general(pdu);
  }
  return {};
}

std::uint8_t ModbusPlc::fault_of_range(bool quantity_right, unsigned address, unsigned count, unsigned size) const {
  const bool inside = address >= settings_.first_address && address - settings_.first_address + count <= size;
  if (settings_.checks == ModbusSettings::Checks::AddressFirst && !inside) return kIllegalAddress;
  if (!quantity_right) return kIllegalQuantity;
  return inside ? settings_.exception : kIllegalAddress;
}

Bytes ModbusPlc::read_bits(Data pdu) {
  if (pdu.size() != 5) return {};
  const bool coils = pdu[0] == static_cast<std::uint8_t>(Function::ReadCoils);
  const unsigned address = load16(&pdu[1]), count = load16(&pdu[3]);
  const unsigned size = coils ? settings_.coils : settings_.inputs;
  if (const auto code = fault_of_range(count >= 1 && count <= settings_.most_read_bits, address, count, size))
    return exception(pdu, code);
  Bytes reply{pdu[0], low_byte((count + 7) / 8)};
  reply.resize(2 + reply[1]);
  const unsigned first = address - settings_.first_address + 1;
  for (unsigned bit = 0; bit < count; ++bit)
    if ((coils ? coils_ : inputs_).read(first + bit) != 0)
      reply[2 + bit / 8] = static_cast<std::uint8_t>(reply[2 + bit / 8] | 1U << bit % 8);
  return reply;
}

/// [M11] Those that the memory ends before are not there.
unsigned ModbusPlc::holding_registers() const {
  return std::min<unsigned>(settings_.holding_registers, kWords - settings_.holding_word);
}

std::uint16_t ModbusPlc::register_at(unsigned address) const {
  return words_.read(settings_.holding_word + address - settings_.first_address);
}

Bytes ModbusPlc::read_registers(Data pdu) {
  if (pdu.size() != 5) return {};
  const bool holding = pdu[0] == static_cast<std::uint8_t>(Function::ReadHoldingRegisters);
  const unsigned address = load16(&pdu[1]), count = load16(&pdu[3]);
  const unsigned size = holding ? holding_registers() : settings_.input_registers;
  if (const auto code = fault_of_range(count >= 1 && count <= settings_.most_registers, address, count, size))
    return exception(pdu, code);
  Bytes reply{pdu[0], low_byte(2 * count)};
  for (unsigned place = address; place < address + count; ++place) {
    const unsigned value = holding ? register_at(place) : input_registers_.read(place - settings_.first_address + 1);
    reply.push_back(high_byte(value));
    reply.push_back(low_byte(value));
  }
  return reply;
}

Bytes ModbusPlc::write_coil(Data pdu) {
  if (pdu.size() != 5) return {};
  const unsigned address = load16(&pdu[1]), value = load16(&pdu[3]);
  if (const auto code = fault_of_range(value == 0 || value == 0xFF00, address, 1, settings_.coils))
    return exception(pdu, code);
  coils_.write(address - settings_.first_address + 1, value != 0 ? 1 : 0);
  return begin_of(pdu, pdu.size());
}

Bytes ModbusPlc::write_register(Data pdu) {
  if (pdu.size() != 5) return {};
  const bool anywhere = settings_.plc == Model::Ncmz && settings_.ncmz_preset == ModbusSettings::NcmzPreset::Memory;
  const unsigned address = load16(&pdu[1]);
  const unsigned size = anywhere ? kWords - settings_.holding_word : holding_registers();
  if (const auto code = fault_of_range(true, address, 1, size)) return exception(pdu, code);
  words_.write(settings_.holding_word + address - settings_.first_address, load16(&pdu[3]));
  return begin_of(pdu, pdu.size());
}

Bytes ModbusPlc::status(Data pdu) const {
  if (pdu.size() != 1) return {};
  if (settings_.exception != 0) return exception(pdu, settings_.exception);
  if (settings_.plc == Model::Ncmz) return {pdu[0], low_byte(words_.read(settings_.holding_word + kStatusRegister - 1))};
  unsigned bits = 0;
  for (unsigned bit = 0; bit < 8; ++bit) bits |= static_cast<unsigned>(coils_.read(settings_.status_coil + bit)) << bit;
  return {pdu[0], low_byte(bits)};
}

/// Returns any four bytes: no loopback code is interpreted.
Bytes ModbusPlc::loopback(Data pdu) const {
  if (pdu.size() == 5 && settings_.exception != 0) return exception(pdu, settings_.exception);
  if (pdu.size() == 5) return begin_of(pdu, pdu.size());
  return settings_.loopback_length == ModbusSettings::WrongLength::Silent ? Bytes{} : exception(pdu, kIllegalQuantity);
}

Bytes ModbusPlc::write_coils(Data pdu) {
  if (pdu.size() < 6) return {};
  const unsigned address = load16(&pdu[1]), count = load16(&pdu[3]);
  const bool fits = pdu[5] == (count + 7) / 8 && pdu.size() == 6U + pdu[5];
  const bool right = fits && count >= 1 && count <= settings_.most_written_coils;
  if (const auto code = fault_of_range(right, address, count, settings_.coils)) return exception(pdu, code);
  const unsigned first = address - settings_.first_address + 1;
  for (unsigned bit = 0; bit < count; ++bit) coils_.write(first + bit, pdu[6 + bit / 8] >> bit % 8 & 1);
  return begin_of(pdu, 5);
}

Bytes ModbusPlc::write_registers(Data pdu) {
  if (pdu.size() < 6) return {};
  const unsigned address = load16(&pdu[1]), count = load16(&pdu[3]);
  const bool fits = pdu[5] == 2 * count && pdu.size() == 6U + pdu[5];
  const bool right = fits && count >= 1 && count <= settings_.most_registers;
  if (const auto code = fault_of_range(right, address, count, holding_registers())) return exception(pdu, code);
  const unsigned first = settings_.holding_word + address - settings_.first_address;
  for (unsigned i = 0; i < count; ++i) words_.write(first + i, load16(&pdu[6 + 2 * i]));
  return begin_of(pdu, 5);
}

Bytes ModbusPlc::slave_id(Data pdu) const {
  if (pdu.size() != 1) return {};
  if (settings_.exception != 0) return exception(pdu, settings_.exception);
  Bytes reply{pdu[0], 0, settings_.slv_id, settings_.run, settings_.mode, settings_.version};
  // An aligning compiler puts the error register at an even place, counted from the start of the message.
  if (settings_.slave_id_layout == ModbusSettings::Layout::Aligned) reply.push_back(0);
  const bool high_first = settings_.slave_id_order == ModbusSettings::ByteOrder::HighFirst;
  for (const std::uint16_t word : {settings_.err, settings_.mode_chg}) {
    reply.push_back(high_first ? high_byte(word) : low_byte(word));
    reply.push_back(high_first ? low_byte(word) : high_byte(word));
  }
  reply[1] = low_byte(static_cast<unsigned>(reply.size()) - 2);
  return reply;
}

std::uint8_t ModbusPlc::memory_byte(std::uint32_t address) const {
  const std::uint16_t word = words_.read(address / 2);
  const bool is_low = (address % 2 == 0) == (settings_.memory_order == ModbusSettings::ByteOrder::LowFirst);
  return is_low ? low_byte(word) : high_byte(word);
}

void ModbusPlc::set_memory_byte(std::uint32_t address, std::uint8_t value) {
  const unsigned word = words_.read(address / 2);
  const bool is_low = (address % 2 == 0) == (settings_.memory_order == ModbusSettings::ByteOrder::LowFirst);
  words_.write(address / 2, static_cast<std::uint16_t>(is_low ? (word & 0xFF00) | value : (word & 0xFF) | value * 256U));
}

Bytes ModbusPlc::general(Data pdu) {
  constexpr std::size_t kHead = 9;  // function, byte count, reference type, segment, offset, number
  if (pdu.size() < kHead) return {};
  const bool reads = pdu[0] == static_cast<std::uint8_t>(Function::ReadFileRecord);
  const unsigned count = load16(&pdu[7]), carried = reads ? 0 : count;
  const std::uint32_t first = std::uint32_t{load16(&pdu[3])} * settings_.segment_bytes + load16(&pdu[5]);
  const bool fits = pdu[1] == kHead - 2 + carried && pdu.size() == kHead + carried;
  const bool right = fits && count >= 1 && count <= settings_.most_bytes;
  const bool inside = pdu[2] == kExtendedMemory && first + count <= kMemoryBytes;
  if (settings_.checks == ModbusSettings::Checks::AddressFirst && !inside) return exception(pdu, kIllegalAddress);
  if (!right) return exception(pdu, kIllegalQuantity);
  if (!inside) return exception(pdu, kIllegalAddress);
  if (settings_.exception != 0) return exception(pdu, settings_.exception);
  if (!reads) {
    for (unsigned i = 0; i < count; ++i) set_memory_byte(first + i, pdu[kHead + i]);
    return begin_of(pdu, pdu.size());
  }
  Bytes reply{pdu[0], low_byte(count)};
  if (settings_.read_answer == ModbusSettings::ReadAnswer::Record)
    reply = {pdu[0], low_byte(count + 2), low_byte(count + 1), kExtendedMemory};
  for (unsigned i = 0; i < count; ++i) reply.push_back(memory_byte(first + i));
  return reply;
}

const std::vector<Setting<ModbusPlc>>& ModbusPlc::settings() {
  using enum SettingForm::Notation;
  using S = ModbusSettings;
  static const std::vector<Setting<ModbusPlc>> kSettings = [] {
    std::vector<Setting<ModbusPlc>> rows;
    const auto own = [](auto& plc) -> auto& { return plc.settings_; };
    const auto add = [&](SettingForm form, auto member) {
      rows.push_back(setting_of<ModbusPlc>(std::move(form), own, member));
    };
    std::vector<std::string_view> models;
    for (const ModelRow& row : kModels) models.push_back(row.word);
    add({"slave", "", "its address, in hex", Hex, {}, 1, UINT8_MAX}, &S::slave);
    add({"plc", "", "model, which decides on its functions", Word, models}, &S::plc);
    add({"slv_id", "", "its identity in the answer to function 17"}, &S::slv_id);
    add({"run", "", "run indicator in the answer to function 17: FF runs, 00 does not"}, &S::run);
    add({"mode", "", "its mode in the answer to function 17"}, &S::mode);
    add({"version", "", "its version in the answer to function 17"}, &S::version);
    add({"err", "", "error register in the answer to function 17", Hex, {}, 0, UINT16_MAX}, &S::err);
    add({"mode_chg", "", "mode change register in the answer to function 17", Hex, {}, 0, UINT16_MAX}, &S::mode_chg);
    add({"exception", "M8", "code that answers all that could be done, as 04 or 06; 00 for none"}, &S::exception);
    add({"function_7", "M1", "section of the document that says which models have it", Word,
         words_of<S::Function7>({{S::Function7::Section422, "section422"}, {S::Function7::Section41, "section41"}})},
        &S::function_7);
    add_line_settings(
        rows, "M2", [](auto& plc) -> auto& { return plc.settings_.line; });
    add({"silence", "M2", "silence that ends a frame, in tenths of a character", Decimal, {}, 1, 200}, &S::silence);
    add({"broadcasts", "M3", "functions carried out for all: 5, 6, 16; or 15 and 21 as well", Word,
         words_of<S::Broadcasts>({{S::Broadcasts::Three, "three"}, {S::Broadcasts::Writes, "writes"}})},
        &S::broadcasts);
    add({"ncmz_preset", "M4", "what function 6 reaches on NCMZ", Word,
         words_of<S::NcmzPreset>({{S::NcmzPreset::Registers, "registers"}, {S::NcmzPreset::Memory, "memory"}})},
        &S::ncmz_preset);
    add({"status_coil", "M5", "coil that is bit 0 in the answer to function 7", Decimal, {}, 1, UINT16_MAX},
        &S::status_coil);
    add({"loopback_length", "M6", "what it does with a loopback of another length than 8", Word,
         words_of<S::WrongLength>({{S::WrongLength::Silent, "silent"}, {S::WrongLength::Refused, "refused"}})},
        &S::loopback_length);
    add({"most_registers", "M7", "registers that one request reads or writes at most", Decimal, {}, 1, 125},
        &S::most_registers);
    add({"most_read_bits", "M7", "coils or inputs that one request reads at most", Decimal, {}, 1, 2000},
        &S::most_read_bits);
    add({"most_written_coils", "M7", "coils that one request writes at most", Decimal, {}, 1, 1968}, &S::most_written_coils);
    add({"checks", "M8", "which fault counts if both are there", Word,
         words_of<S::Checks>({{S::Checks::QuantityFirst, "quantity_first"}, {S::Checks::AddressFirst, "address_first"}})},
        &S::checks);
    add({"first_address", "M9", "address of the first coil, input or register on the wire", Decimal, {}, 0, 1},
        &S::first_address);
    add({"coils", "M10", "how many coils it has", Decimal, {}, 0, UINT16_MAX}, &S::coils);
    add({"inputs", "M10", "how many inputs it has", Decimal, {}, 0, UINT16_MAX}, &S::inputs);
    add({"input_registers", "M10", "how many input registers it has", Decimal, {}, 0, UINT16_MAX}, &S::input_registers);
    add({"holding_registers", "M10", "how many holding registers it has", Decimal, {}, 0, UINT16_MAX},
        &S::holding_registers);
    add({"holding_word", "M11", "word of the memory that HR1 is", Hex, {}, 0, UINT16_MAX}, &S::holding_word);
    add({"slave_id_layout", "M12", "answer to function 17: with a byte before the error register or without", Word,
         words_of<S::Layout>({{S::Layout::Packed, "packed"}, {S::Layout::Aligned, "aligned"}})},
        &S::slave_id_layout);
    add({"slave_id_order", "M12", "order of the bytes of words in the answer to function 17", Word,
         words_of<S::ByteOrder>({{S::ByteOrder::HighFirst, "high_first"}, {S::ByteOrder::LowFirst, "low_first"}})},
        &S::slave_id_order);
    add({"read_answer", "M13", "answer to function 20: as Modbus has it, or a byte count and data", Word,
         words_of<S::ReadAnswer>({{S::ReadAnswer::Record, "record"}, {S::ReadAnswer::Plain, "plain"}})},
        &S::read_answer);
    add({"segment_bytes", "M14", "bytes from one segment to the next", Decimal, {}, 1, UINT16_MAX}, &S::segment_bytes);
    add({"memory_order", "M14", "order of the bytes of a word", Word,
         words_of<S::ByteOrder>({{S::ByteOrder::HighFirst, "high_first"}, {S::ByteOrder::LowFirst, "low_first"}})},
        &S::memory_order);
    add({"most_bytes", "M15", "bytes that function 20 reads or function 21 writes at most", Decimal, {}, 1, 244},
        &S::most_bytes);
    return rows;
  }();
  return kSettings;
}

const std::vector<Cells<ModbusPlc>>& ModbusPlc::cells() {
  static const std::vector<Cells<ModbusPlc>> kCells{
      {"CR", false, 1, UINT16_MAX, 1, "coils", [](const ModbusPlc& plc, std::uint32_t n) { return plc.coils_.read(n); },
       [](ModbusPlc& plc, std::uint32_t n, std::uint32_t value) { plc.coils_.write(n, low_byte(value)); },
       [](const ModbusPlc& plc) -> std::uint32_t { return plc.settings_.coils; }, "coils"},
      {"IN", false, 1, UINT16_MAX, 1, "inputs", [](const ModbusPlc& plc, std::uint32_t n) { return plc.inputs_.read(n); },
       [](ModbusPlc& plc, std::uint32_t n, std::uint32_t value) { plc.inputs_.write(n, low_byte(value)); },
       [](const ModbusPlc& plc) -> std::uint32_t { return plc.settings_.inputs; }, "inputs"},
      {"HR", false, 1, UINT16_MAX, UINT16_MAX, "holding registers",
       [](const ModbusPlc& plc, std::uint32_t n) { return plc.words_.read(plc.settings_.holding_word + n - 1); },
       [](ModbusPlc& plc, std::uint32_t n, std::uint32_t value) {
         plc.words_.write(plc.settings_.holding_word + n - 1, static_cast<std::uint16_t>(value));
       },
       [](const ModbusPlc& plc) -> std::uint32_t { return plc.holding_registers(); }, "holding_registers"},
      {"IR", false, 1, UINT16_MAX, UINT16_MAX, "input registers",
       [](const ModbusPlc& plc, std::uint32_t n) { return plc.input_registers_.read(n); },
       [](ModbusPlc& plc, std::uint32_t n, std::uint32_t value) {
         plc.input_registers_.write(n, static_cast<std::uint16_t>(value));
       },
       [](const ModbusPlc& plc) -> std::uint32_t { return plc.settings_.input_registers; }, "input_registers"},
      {"W", true, 0, UINT16_MAX, UINT16_MAX, "words of the memory",
       [](const ModbusPlc& plc, std::uint32_t a) { return plc.words_.read(a); },
       [](ModbusPlc& plc, std::uint32_t a, std::uint32_t value) { plc.words_.write(a, static_cast<std::uint16_t>(value)); }},
  };
  return kCells;
}

}  // namespace s7200::westinghouse
