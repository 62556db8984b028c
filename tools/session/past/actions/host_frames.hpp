// What a host port has put on its line, from what was asked of it.
#pragma once

#include <cstdint>
#include <vector>

#include "serial_sim/line/frame.hpp"
#include "serial_sim/peers/host_port.hpp"

namespace s7200::tools {

/// A frame that came in from outside.
struct SentByHost {
  Time from = 0, to = 0;
  std::vector<std::uint8_t> bytes{};
  SerialFormat format{};
};

/// Characters that it sent back to back, with what is wrong with them.
struct HostTransmission {
  Time from = 0, to = 0;
  serial::Frame frame{};
  SerialFormat format{};
  bool lacks_stop_bit = false;  ///< one of them
};

class HostFrames {
 public:
  /// Must be told the calls of the port in their order, with their moments.
  void note(const serial::HostCall& call, Time at);

  /// Pieces that follow each other within kNextPiece are one, unless the first of them are a whole Modbus RTU frame.
  std::vector<SentByHost> frames() const;

  std::vector<HostTransmission> transmissions() const;

 private:
  struct Character {
    std::uint8_t byte = 0;
    serial::HostCharacter::Fault fault{};
    std::uint64_t sender = 0;
    SerialFormat format{};
    Time lasts = 0;  ///< of a break; 0: its end is not known yet
    Time from = 0, to = 0;
  };

  static Time duration(const Character& character);
  void append(Character character, Time at);
  void drop(std::uint64_t sender, Time at);
  void end_break(std::uint64_t sender, Time lasts);

  std::vector<Character> characters_{};
};

}  // namespace s7200::tools
