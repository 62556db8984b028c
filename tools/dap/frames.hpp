// Frames as people write them: `01 03 00 0a 00 01 crc`, `'HELLO\r'`.
#pragma once

#include <string>

#include "serial_sim/line/frame.hpp"

namespace s7200::tools::dap {

/// `crc` at the end appends the Modbus CRC. Throws Refused.
serial::Frame read_frame(const std::string& text);

}  // namespace s7200::tools::dap
