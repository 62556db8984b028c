// A PC503 at its loader port, the programming port of PC500 and PC2000.
//
// [S1] … [S5] name the choices of ../shared/reference/westinghouse_protocols.md.
//
// Not documented, modelled so:
// - It answers 400 us after a request, less than the document's 500. [Loader.AnAnswerBegins400MicrosecondsAfterTheRequest]
// - After power has been off it has its memory, and the session is over. [Loader.AfterPowerHasBeenOffTheSessionIsOver]
#pragma once

#include "serial_sim/westinghouse/loader_session.hpp"
#include "serial_sim/westinghouse/memory.hpp"
#include "serial_sim/westinghouse/plc.hpp"

namespace s7200::westinghouse {

struct LoaderSettings {
  enum class Nak : std::uint8_t { Sent, Silent };
  enum class Writable : std::uint8_t { All, Areas };

  SerialFormat line{};             ///< 8E1, as the document says
  std::uint16_t latency_us = 400;  ///< of an answer; below 500 in the document

  FirstBlock directory = FirstBlock::Db0;  ///< [S1]
  std::uint8_t head_bytes = 5;             ///< [S2] 00, before the pointers of opcode 18
  std::uint8_t tail_bytes = 0;             ///< [S2] 00, after them
  Dle dle = Dle::Doubled;                  ///< [S3]
  std::uint16_t timeout_ms = 500;          ///< [S4] for each byte within a session
  Nak nak = Nak::Sent;                     ///< [S4] to what does not fit
  Writable writable = Writable::All;       ///< [S5]

  bool operator==(const LoaderSettings&) const = default;
};

class LoaderPlc final : public PlcOf<LoaderPlc> {
 public:
  LoaderPlc();

  static const std::vector<Setting<LoaderPlc>>& settings();
  static const std::vector<Cells<LoaderPlc>>& cells();

  SerialFormat format() const override { return settings_.line; }
  void hear(const ReceivedCharacter& character) override;
  void wake(Time now) override;
  void restart(Time at) override;

  bool operator==(const LoaderPlc&) const = default;

 private:
  void take(std::uint8_t byte, Time end);
  void take_acknowledgement(std::uint8_t byte, Time end);
  void take_argument(std::uint8_t byte, Time end);
  void acknowledged(Time end);
  void carry_out(Time end);
  void go_on(Time end);
  void refuse(Time end);
  void say(Bytes bytes, Time request_end);
  void go_idle();

  /// Carries out the operation. Returns false if its arguments are wrong.
  bool run();
  bool read();
  bool write();
  bool describe_block();
  void add_memory(std::uint32_t first, std::uint32_t count);
  std::uint16_t word(std::uint32_t address) const;
  void put(std::uint32_t address, std::span<const std::uint8_t> bytes);

  LoaderSettings settings_;
  ByteMemory memory_;
  LoaderStep due_ = LoaderStep::Begin;  // of the computer
  bool in_arguments_ = false;           // what precedes them is there
  std::uint8_t opcode_ = 0;
  bool dle_ = false;  // was the byte before
  Bytes arguments_;
  Bytes data_;  // of the answer
};

}  // namespace s7200::westinghouse
