// A client of a serial port over TCP: Telnet (RFC 854, 855, 856) with the COM-PORT-OPTION (RFC 2217), as the port's server.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "interpreter/base/serial_format.hpp"
#include "interpreter/base/serial_port.hpp"

namespace s7200::tools {

/// Bytes in from the client, bytes out to it. It knows no sockets and no line.
///
/// Until a client sets something, its characters are as the PLC's port is set: each setting it makes holds from its next
/// character on. What a port of an S7-200 cannot do (5 data bits, mark parity …) stays as it is, and the answer says so, as
/// RFC 2217 has it. DTR, RTS and flow control are noted and answered; an RS-485 line has none of them.
/// Not documented, modelled so: a break lasts as long as the client holds it, but at least HostCharacter::kBreakBits, since
/// TCP may bring both of its ends at once. [HostPort.ABreakLastsAsLongAsItIsHeld, HostPort.ABreakIsLongerThanAnyCharacter]
class ComPort {
 public:
  static constexpr std::size_t kMostOfCommand = 64;  ///< bytes of a subnegotiation; no command of RFC 2217 has more than 10

  struct Port {
    std::function<SerialFormat()> format;         ///< of the PLC
    std::function<void(std::uint8_t)> character;  ///< the client sends it
    std::function<void()> begin_break;            ///< the client holds the line at space from now on
    std::function<void()> end_break;              ///< no longer
    std::function<void()> purge;                  ///< what the client has sent and is not on the line yet goes
  };

  explicit ComPort(Port port) : port_(std::move(port)) {}

  /// Takes bytes from the client. Returns the bytes to answer.
  std::vector<std::uint8_t> take(std::span<const std::uint8_t> bytes);

  /// The bytes for the client for characters from the line: an error that it has asked to be told of comes in front of its
  /// character.
  std::vector<std::uint8_t> received(std::span<const ReceivedCharacter> characters) const;

  /// The format of the client's characters.
  SerialFormat format() const;

  /// Why nothing more can come of what the client says; empty as long as something can.
  const std::string& error() const { return error_; }

 private:
  enum class State : std::uint8_t { Data, Command, Option, Subnegotiation, SubnegotiationCommand };

  void take(std::uint8_t byte);
  void negotiate(std::uint8_t verb, std::uint8_t option);
  void command();
  void set_control(std::uint8_t value);
  void answer(std::uint8_t command, std::span<const std::uint8_t> value);
  void answer(std::uint8_t command, std::uint8_t value) { answer(command, std::span(&value, 1)); }

  Port port_;
  State state_ = State::Data;
  std::uint8_t verb_ = 0;
  std::vector<std::uint8_t> command_;  // a subnegotiation so far
  std::vector<std::uint8_t> out_;
  std::string error_;

  std::uint32_t baud_ = 0;  // 0: as the PLC is set, here and below
  std::uint8_t data_bits_ = 0, parity_ = 0, stop_bits_ = 0;
  bool dtr_ = false, rts_ = false, break_ = false;
  std::uint8_t flow_out_ = 1, flow_in_ = 14;  // no flow control
  std::uint8_t line_errors_ = 0;              // the mask of what it wants to be told
  std::uint32_t confirmed_ = 0;               // options that both ends have agreed on, a bit each, ours and the client's
};

}  // namespace s7200::tools
