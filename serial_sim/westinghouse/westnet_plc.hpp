// Westnet II: a computer's own programmable controller interface (PCI), and a PLC at another drop of the highway.
//
// [W1] … [W7] name the choices of ../shared/reference/westinghouse_protocols.md.
//
// Not documented, modelled so:
// - Operands that are 00 in every message of the document have to be 00. [Westnet.W7WhatIsNotUnderstoodIsNotAnswered]
// - After power has been off it has its memory; no drop is addressed, and no session is open.
//   [Westnet.AfterPowerHasBeenOffNoDropIsAddressedAndNoSessionIsOpen]
#pragma once

#include "serial_sim/westinghouse/pc1000.hpp"

namespace s7200::westinghouse {

struct WestnetSettings {
  enum class FreeStatus : std::uint8_t { Zeros, Addressed };
  enum class BusyCode : std::uint8_t { Hex, Decimal };
  enum class NewAddress : std::uint8_t { KeepsSession, ClosesSession };
  enum class Status : std::uint8_t { UntilSuccess, Once };
  enum class MissingPlc : std::uint8_t { Acknowledged, Refused };

  std::uint32_t local = 0x000100, plc_at = 0x001100;  ///< highway, drop, subdrop
  std::uint32_t remote = kNowhere;                    ///< that is addressed
  std::uint32_t session = kNowhere;                   ///< drop that is in session with the PLC

  SerialFormat line{.parity = Parity::None};          ///< [W1]
  std::uint16_t gap_ms = 100;                         ///< [W1] between two characters of a message, at most
  std::uint8_t answer_after = 1;                      ///< [W1] characters
  FreeStatus free_status = FreeStatus::Zeros;         ///< [W2]
  BusyCode busy_code = BusyCode::Hex;                 ///< [W3]
  NewAddress new_address = NewAddress::KeepsSession;  ///< [W4]
  std::uint8_t error_byte = kHighwayError;            ///< [W5]
  Status status = Status::UntilSuccess;               ///< [W5]
  MissingPlc missing_plc = MissingPlc::Acknowledged;  ///< [W6]
  std::uint8_t malformed = 0;                         ///< [W7] answered as an error; 0: silence

  bool operator==(const WestnetSettings&) const = default;
};

class WestnetPlc final : public PlcOf<WestnetPlc> {
 public:
  static const std::vector<Setting<WestnetPlc>>& settings();
  static const std::vector<Cells<WestnetPlc>>& cells();

  SerialFormat format() const override { return settings_.line; }
  void hear(const ReceivedCharacter& character) override;
  void wake(Time now) override;
  void restart(Time at) override;

  bool operator==(const WestnetPlc&) const = default;

 private:
  using Data = std::span<const std::uint8_t>;

  Bytes reply(Data message);
  Bytes highway(Data message);
  Bytes set_address(Data message);
  /// The error that is in the way of open, close and session status, and of commands for the PLC; 0 if there is none.
  std::uint8_t fault_of_plc() const;
  std::uint8_t fault_of_session() const;
  std::uint8_t busy() const { return settings_.busy_code == WestnetSettings::BusyCode::Hex ? 0x12 : 12; }
  /// The error that the highway's status shows from now on; silence if `code` is 0.
  Bytes error(std::uint8_t code);

  WestnetSettings settings_;
  Pc1000 pc_;
  std::uint8_t status_ = 0;  // of the highway
  MessageReader reader_;
};

}  // namespace s7200::westinghouse
