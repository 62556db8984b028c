// `--tcp`, `--rfc2217`, `--rtu-over-tcp`, `--modbus-tcp`: the line as a TCP port.
#pragma once

#include <memory>

#include "serial_sim/peers/requester.hpp"
#include "tools/bridge/bridge.hpp"
#include "interpreter/base/listen_address.hpp"

namespace s7200::tools {

/// Raw bytes, as a serial device server passes them on. Clients share the line like stations on a wire: what any of them
/// sends goes out in the order of its arrival, what the line says goes to all.
std::unique_ptr<Bridge> make_tcp_bridge(const ListenAddress& address);

/// A serial port as RFC 2217 has it, see ComPort. Clients share the line; each has settings of its own, in which its
/// characters go out, and the line is heard as who spoke or came last is set. What `line` says holds whatever a client sets.
std::unique_ptr<Bridge> make_rfc2217_bridge(const ListenAddress& address, const serial::LineSettings& line);

/// RTU frames. What a client sends is a frame when its CRC is right. With a wrong one it is passed on too: 20 ms after its
/// last byte if it is as long as its function says, after a second if the function is not known. What is shorter than a
/// frame never goes on the line: it waits for its rest, and is given up when none comes for a second, or when a whole frame
/// comes after a pause. Clients take turns, and each hears the answer to its own frame, in one piece. One that sends again
/// has stopped waiting: what it sent before and is not on the line yet is dropped, except broadcasts.
std::unique_ptr<Bridge> make_rtu_over_tcp_bridge(const ListenAddress& address, Time timeout);

/// Makes a gateway, see modbus::Gateway.
std::unique_ptr<Bridge> make_modbus_tcp_bridge(const ListenAddress& address, Time timeout);

}  // namespace s7200::tools
