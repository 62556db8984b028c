// A frame for the line, as people write it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "interpreter/base/result.hpp"
#include "serial_sim/line/frame.hpp"

namespace s7200::tools {

/// `01 03 00 0a 00 01`, `'HELLO\r'`, with `crc` after it if the Modbus CRC is to be appended; `read 40011:2`,
/// `write 40011=5,6`, `write 00003=on`, with `station 4` after it unless it is for `station`. Trouble for
/// anything else.
Result<serial::Frame> parse_frame(const std::string& text, std::uint8_t station);

}  // namespace s7200::tools
