// `--pty LINK`: the line as a serial port that programs of this computer open.
//
// A program's bytes go on the line back to back from the moment they come, at its own rate. What the line says is there for
// it with the middle of each stop bit. While no program has the port open, what the line says is lost; what was written
// before a program left is still sent, for 10 s. Several programs may have it open at once. Each has settings of its own,
// hears all that the line says, and what they write goes out in the order in which it comes. The line is heard as who wrote
// or came last is set.
#pragma once

#include <string>

#include "serial_sim/peers/requester.hpp"
#include "tools/bridge/bridge.hpp"

namespace s7200::tools {

/// Makes a bridge to a pty. The settings in `line` hold whatever a program sets; settings that a pty cannot show and `line`
/// leaves open are those of the PLC.
std::unique_ptr<Bridge> make_pty_bridge(const std::string& link, const serial::LineSettings& line);

}  // namespace s7200::tools
