// A PLC on the PC1000 LAN: who is addressed, the sync signal, and when a message counts.
//
// Not documented, modelled so:
// - Operands that are 00 in every message of the document have to be 00. [Pc1000Lan.L8WhatIsWrongOrRefusedIsNotAnswered]
// - After power has been off it has its memory, and no unit is addressed.
//   [Pc1000Lan.AfterPowerHasBeenOffMemoryIsKeptAndNoUnitIsAddressed]
#pragma once

#include "serial_sim/westinghouse/pc1000.hpp"

namespace s7200::westinghouse {

struct LanSettings {
  enum class Sync : std::uint8_t { Required, Ignored };

  std::uint8_t unit = 5;
  SerialFormat line{.parity = Parity::None};  ///< [L1]
  Sync sync = Sync::Required;                 ///< [L2]
  std::uint16_t gap_ms = 100;                 ///< [L3] between two characters of a message, at most
  std::uint8_t answer_after = 1;              ///< [L3] characters

  bool operator==(const LanSettings&) const = default;
};

class LanPlc final : public PlcOf<LanPlc> {
 public:
  static const std::vector<Setting<LanPlc>>& settings();
  static const std::vector<Cells<LanPlc>>& cells();

  SerialFormat format() const override { return settings_.line; }
  bool needs_sync() const override { return settings_.sync == LanSettings::Sync::Required; }
  void hear(const ReceivedCharacter& character) override;
  void sync(bool high, Time at) override;
  void wake(Time now) override;
  void restart(Time at) override;

  bool operator==(const LanPlc&) const = default;

 private:
  /// The reply to a whole message; empty for silence.
  Bytes reply(std::span<const std::uint8_t> message);
  Bytes set_unit_address(std::span<const std::uint8_t> message);
  /// Empty for silence, or the message that is sent instead of it [L8].
  Bytes refusal() const;
  void begin_anew();

  LanSettings settings_;
  Pc1000 pc_;
  bool on_line_ = false;
  bool sync_high_ = false;
  Time sync_since_ = 0;
  MessageReader reader_;
};

}  // namespace s7200::westinghouse
