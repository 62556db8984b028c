// The Modbus personality: what PLCs of this family answer as slaves of Modbus RTU.
//
// [M1], [M2] and so on name the choices of ../shared/reference/westinghouse_protocols.md where the document is silent. Each
// is a setting; its default is what the reference says.
//
// Not documented, modelled so:
// - A request that is not as long as its function has it is not answered. One of function 15, 16, 20 or 21 is answered with
//   exception 03 if all that says how long it is is there. [WestinghouseModbus.WhatIsMalformedIsNotAnswered,
//   WestinghouseModbus.WhatSaysAnotherLengthThanItHasIsAnsweredWithException3]
// - After power has been off it has its memory and settings. [WestinghouseModbus.AfterPowerHasBeenOffItHasItsMemory]
#pragma once

#include <span>

#include "serial_sim/westinghouse/memory.hpp"
#include "serial_sim/westinghouse/plc.hpp"

namespace s7200::westinghouse {

struct ModbusSettings {
  enum class Model : std::uint8_t { Pc503, Pc1200, Pc1250, Pc2000, Ncmz, Hppc };
  enum class Function7 : std::uint8_t { Section422, Section41 };  ///< which section of the document is followed
  enum class Broadcasts : std::uint8_t { Three, Writes };
  enum class NcmzPreset : std::uint8_t { Registers, Memory };
  enum class WrongLength : std::uint8_t { Silent, Refused };
  enum class Checks : std::uint8_t { QuantityFirst, AddressFirst };
  enum class Layout : std::uint8_t { Packed, Aligned };
  enum class ByteOrder : std::uint8_t { HighFirst, LowFirst };
  enum class ReadAnswer : std::uint8_t { Record, Plain };

  std::uint8_t slave = 1;
  Model plc = Model::Pc1200;
  std::uint8_t slv_id = 0, run = 0xFF, mode = 0, version = 0;  ///< function 17
  std::uint16_t err = 0, mode_chg = 0;
  std::uint8_t exception = 0;  ///< [M8] answered instead of doing anything: 04 or 06; 0: none

  Function7 function_7 = Function7::Section422;                                          ///< [M1]
  SerialFormat line{.parity = Parity::None};                                             ///< [M2]
  std::uint8_t silence = 35;                                                             ///< [M2] tenths of a character
  Broadcasts broadcasts = Broadcasts::Three;                                             ///< [M3]
  NcmzPreset ncmz_preset = NcmzPreset::Registers;                                        ///< [M4]
  std::uint16_t status_coil = 1017;                                                      ///< [M5]
  WrongLength loopback_length = WrongLength::Silent;                                     ///< [M6]
  std::uint16_t most_registers = 125, most_read_bits = 2000, most_written_coils = 1968;  ///< [M7]
  Checks checks = Checks::QuantityFirst;                                                 ///< [M8]
  std::uint16_t first_address = 0;                                                       ///< [M9]
  std::uint16_t coils = 1024, inputs = 1024, input_registers = 256, holding_registers = 2048;  ///< [M10]
  std::uint16_t holding_word = 0;                   ///< [M11] word of memory that HR1 is
  Layout slave_id_layout = Layout::Packed;          ///< [M12]
  ByteOrder slave_id_order = ByteOrder::HighFirst;  ///< [M12]
  ReadAnswer read_answer = ReadAnswer::Record;      ///< [M13]
  std::uint16_t segment_bytes = 16;                 ///< [M14]
  ByteOrder memory_order = ByteOrder::LowFirst;     ///< [M14]
  std::uint8_t most_bytes = 244;                    ///< [M15]

  bool operator==(const ModbusSettings&) const = default;
};

class ModbusPlc final : public PlcOf<ModbusPlc> {
 public:
  static const std::vector<Setting<ModbusPlc>>& settings();
  static const std::vector<Cells<ModbusPlc>>& cells();

  SerialFormat format() const override { return settings_.line; }
  void hear(const ReceivedCharacter& character) override;
  void wake(Time now) override;
  void restart(Time at) override;

  const ModbusSettings& setting() const { return settings_; }
  ModbusSettings& setting() { return settings_; }

  bool operator==(const ModbusPlc&) const = default;

 private:
  using Data = std::span<const std::uint8_t>;

  /// The reply to `pdu`, without station and CRC; empty for silence.
  Bytes reply(Data pdu);
  bool supports(std::uint8_t function) const;
  bool carries_out_broadcast(std::uint8_t function) const;

  Bytes read_bits(Data pdu);
  Bytes read_registers(Data pdu);
  Bytes write_coil(Data pdu);
  Bytes write_register(Data pdu);
  Bytes status(Data pdu) const;
  Bytes loopback(Data pdu) const;
  Bytes write_coils(Data pdu);
  Bytes write_registers(Data pdu);
  Bytes slave_id(Data pdu) const;
  Bytes general(Data pdu);

  /// The exception for a wrong quantity or address; 0 if both are right.
  std::uint8_t fault_of_range(bool quantity_right, unsigned address, unsigned count, unsigned size) const;

  unsigned holding_registers() const;
  std::uint16_t register_at(unsigned address) const;
  std::uint8_t memory_byte(std::uint32_t address) const;
  void set_memory_byte(std::uint32_t address, std::uint8_t value);

  ModbusSettings settings_;
  Memory<std::uint8_t> coils_, inputs_;  // by number, 0 or 1
  WordMemory input_registers_;           // by number
  WordMemory words_;                     // [M11]
  Bytes frame_;
  bool damaged_ = false;
};

}  // namespace s7200::westinghouse
