// The target of a master as people write it.
#pragma once

#include <initializer_list>
#include <memory>
#include <string>

#include "interpreter/base/serial_format.hpp"
#include "interpreter/base/stop_token.hpp"
#include "serial_sim/modbus/crc.hpp"
#include "tools/slave/slave.hpp"

namespace s7200::tools {

/// The prefix of the model of a simulated PLC of another make.
inline constexpr std::string_view kOtherPlc = "westinghouse:";

struct SlaveTarget {
  enum class Kind : std::uint8_t {
    Program,    ///< a PROGRAM to be run in simulation: whatever is none of the others
    System,     ///< a system file, SYSTEM.yaml, to be run in simulation
    Device,     ///< a character device, or a link to one: a pty; whatever begins with /dev/tty
    Tcp,        ///< tcp://HOST:PORT, the characters of a serial line over TCP
    ModbusTcp,  ///< modbus-tcp://HOST[:PORT], port 502 if none is given
    Peer,       ///< westinghouse:MODEL, a simulated PLC of another make
  };

  Kind kind = Kind::Program;
  std::string path;        ///< of a program, system file or device; a model
  std::string host, port;  ///< an IPv6 address without its brackets
};

/// Parses a target. Throws std::invalid_argument for an address without host or port, and for a scheme that is neither.
SlaveTarget parse_slave_target(const std::string& text);

/// Whether the target is westinghouse:MODEL.
bool is_other_plc(std::string_view text);

/// The targets but `without`, one a line, for --help; `device` describes the device at the end of a serial line.
std::string slave_targets_help(
    std::initializer_list<SlaveTarget::Kind> without = {},
    std::string_view device = "a serial line, for Modbus 9600 8E1 unless --baud and the others say otherwise");

/// Connects to a target outside simulation; `format` is for devices, `is_complete` for characters. Throws
/// SlaveUnreachable, and std::invalid_argument for a target in simulation.
std::unique_ptr<Slave> connect(const SlaveTarget& target, const SerialFormat& format, IsComplete is_complete,
                               StopToken stop);

}  // namespace s7200::tools
