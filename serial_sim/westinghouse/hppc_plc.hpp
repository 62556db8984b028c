// An HPPC at its loader port.
//
// [H1] … [H10] name the choices of ../shared/reference/westinghouse_protocols.md.
//
// Not documented, modelled so:
// - It answers whoever asked. [Hppc.ItAnswersWhoeverAsked]
// - Its answer begins one character after the request. [Hppc.AnAnswerBeginsOneCharacterAfterTheRequest]
// - After power has been off it has its memory and looks for its line again.
//   [Hppc.AfterPowerHasBeenOffItSearchesForItsLineAgainAndHasItsMemory]
#pragma once

#include "serial_sim/westinghouse/memory.hpp"
#include "serial_sim/westinghouse/messages/hppc_message.hpp"
#include "serial_sim/westinghouse/plc.hpp"

namespace s7200::westinghouse {

struct HppcSettings {
  enum class Port : std::uint8_t { Sim0, Iop };
  enum class Run : std::uint8_t { Running, Stopped };
  enum class ZeroByte : std::uint8_t { Ignored, Checked };
  enum class Errors : std::uint8_t { Answered, Ignored };
  enum class Table : std::uint8_t { Section66, Example };
  static constexpr std::uint8_t kAsItIs = 0xFF;

  Port port = Port::Sim0;
  Run run = Run::Running;
  FcsTable fcs = FcsTable::Document;
  std::uint16_t edit_lo = 0;  ///< [H8] the register in error responses

  SerialFormat line{.parity = Parity::None};  ///< [H1]
  std::uint16_t search_ms = 0;                ///< [H2] for its line, after power-up: it hears nothing
  ZeroByte zero_byte = ZeroByte::Ignored;     ///< [H3]
  HppcLayout layout{};                        ///< [H4] [H5] [H6]
  std::uint8_t status = kAsItIs;              ///< [H7] of a monitor
  Errors errors = Errors::Answered;           ///< [H8]
  Table table = Table::Section66;             ///< [H10]
  std::uint8_t answer_after = 1;              ///< characters

  bool operator==(const HppcSettings&) const = default;
};

class HppcPlc final : public PlcOf<HppcPlc> {
 public:
  HppcPlc() { put_table(); }

  static const std::vector<Setting<HppcPlc>>& settings();
  static const std::vector<Cells<HppcPlc>>& cells();

  SerialFormat format() const override { return settings_.line; }
  void hear(const ReceivedCharacter& character) override;
  void wake(Time now) override;
  void restart(Time at) override;
  bool full_duplex() const override { return true; }

  bool operator==(const HppcPlc&) const = default;

 private:
  using Data = std::span<const std::uint8_t>;

  /// An answer's opcode and operands, or an error.
  struct Reply {
    std::uint8_t error = 0;
    Bytes operands{};
  };

  void begin_anew();
  void take(Data message, Time end);
  Reply carry_out(std::uint8_t opcode, Data operands);
  Reply parameters(Data operands) const;
  Reply read(Data operands) const;
  Reply write(Data operands);
  Reply write_bits(Data operands);
  Reply monitor(Data operands) const;
  std::uint8_t monitor_status(std::uint32_t network) const;

  std::uint32_t value(std::uint32_t address, std::size_t bytes) const;
  void put(std::uint32_t address, std::uint32_t value, std::size_t bytes);
  void put_table();

  HppcSettings settings_;
  ByteMemory memory_;
  Bytes message_;
  bool deaf_ = false;  // until a gap
  Time begun_ = 0;     // the message
  Time powered_since_ = 0;
  Time sends_until_ = 0;
};

}  // namespace s7200::westinghouse
