// Characters and frames out of the edges on both wires.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "interpreter/base/event_queue.hpp"
#include "serial_sim/line/line.hpp"
#include "serial_sim/line/uart.hpp"
#include "serial_sim/line/wire_tap.hpp"

namespace s7200::serial {

/// What ran over one wire, between two silences or until the other end of the line spoke.
struct WireFrame {
  Wire wire{};
  std::vector<ReceivedCharacter> characters;  ///< as they were read, those with errors too
  Time end = 0;                               ///< of the last stop bit

  Time start() const { return characters.front().start; }
};

/// Listens to each wire with a UART that is set like the PLC's port and never switched off. What ends a frame: a silence of
/// more than 3.5 characters, or a character on the other wire that begins after it, however soon the next one follows.
/// Stations that share the Rx wire are told apart by silence alone.
class FrameSplitter final : public WireSink {
 public:
  /// Where no silence comes, a frame ends after so many characters.
  static constexpr std::size_t kLongestFrame = 4096;

  /// `on_frame` is told in the order in which frames begin.
  explicit FrameSplitter(std::function<void(const WireFrame&)> on_frame);

  void edge(Wire wire, Time at, bool mark) override;
  void settled(Time until, const SerialFormat& port) override;

  /// What has come of the last frames is told too. An incomplete character does not count.
  void finish() override;

 private:
  /// A wire of its own, so that the UART is the one that hears the real one.
  struct Ear {
    Line line;
    EventQueue queue;
    Uart uart{line, queue, EventOwner{}, 0};
    WireFrame open;
    Time last_start = -1;  ///< of the last character
  };

  void hear(Time until, const SerialFormat& port);
  void take(std::size_t wire, const ReceivedCharacter& character, const SerialFormat& port);
  void close(Ear& ear);
  void tell();

  std::array<Ear, kWires> ears_;
  std::vector<WireFrame> closed_;  ///< and not told yet
  std::function<void(const WireFrame&)> on_frame_;
};

}  // namespace s7200::serial
