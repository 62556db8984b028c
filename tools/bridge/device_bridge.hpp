// `--device /dev/ttyUSB0`: joins the line to a real one, at a serial device of this computer.
#pragma once

#include <memory>
#include <string>

#include "tools/bridge/bridge.hpp"

namespace s7200::tools {

/// The device is set as the PLC's port is, and follows it. A character that comes in with an error goes on the simulated
/// line with wrong parity, or in a format without parity with no stop bit. Characters pass on whole, so that each way they
/// are later by one character than on a wire.
std::unique_ptr<Bridge> make_device_bridge(const std::string& path);

}  // namespace s7200::tools
