// Characters and frames out of the edges of the line.
#pragma once

#include <functional>
#include <vector>

#include "interpreter/base/event_queue.hpp"
#include "serial_sim/line/line.hpp"
#include "serial_sim/line/uart.hpp"
#include "serial_sim/line/wire_tap.hpp"

namespace s7200::serial {

/// A frame on the wire: the characters between two silences, or until another station sends.
struct WireFrame {
  int driver = Line::kNobody;                 ///< of the station that began it
  std::vector<ReceivedCharacter> characters;  ///< as they were read, those with errors too
  Time end = 0;                               ///< of the last stop bit

  Time start() const { return characters.front().start; }
};

/// Listens to Wire::Line with a UART that is set like the PLC's port, never sends and is never switched off: it reads what
/// is on the wire, of a collision what both senders make of it. What ends a frame: a silence of more than 3.5 characters, or
/// a character after it that another station sends, however soon that follows. Stations that have sent at the same time are
/// not told from each other until there is silence. All programs behind a bridge are one station.
class FrameSplitter final : public WireSink {
 public:
  /// A frame that no silence ends is cut after so many characters.
  static constexpr std::size_t kLongestFrame = 4096;

  /// The splitter calls `on_frame` in the order in which frames begin.
  explicit FrameSplitter(std::function<void(const WireFrame&)> on_frame) : on_frame_(std::move(on_frame)) {}

  void edge(Wire wire, Time at, bool mark, int driver) override;
  void settled(Time until, const SerialFormat& port) override;

  /// Reports the last frame too. An incomplete character does not count.
  void finish() override { close(); }

 private:
  void take(const ReceivedCharacter& character, const SerialFormat& port);
  void close();
  int sender_of(const ReceivedCharacter& character);
  bool another_drives(int sender, const ReceivedCharacter& character);

  struct Speaker {
    Time since;
    int driver;
  };

  // A line of its own, so that the UART is the one that hears the real one.
  Line line_;
  EventQueue queue_;
  Uart uart_{line_, queue_, EventOwner{}, 0};
  std::vector<Speaker> speakers_;  ///< stations that drove the line to space, in order of time; neighbours differ
  std::vector<Speaker> driving_;   ///< stations that began to drive to space since the last character, seen or not
  WireFrame open_;
  int sender_ = Line::kNobody;  ///< of the open frame's last character
  bool mixed_ = false;          ///< several have sent characters of the open frame at the same time
  std::function<void(const WireFrame&)> on_frame_;
};

}  // namespace s7200::serial
