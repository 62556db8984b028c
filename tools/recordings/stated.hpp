// What a recording says in words of the line that it was made on.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "interpreter/base/time.hpp"
#include "serial_sim/line/line_settings.hpp"

namespace s7200::tools {

struct StatedLine {
  serial::LineSettings line{};
  std::size_t number = 0;         ///< of the first line of the text that says something of it; 0: none does
  bool is_contradictory = false;  ///< several rates are stated, and none of them is taken
  std::optional<Time> timeout{};  ///< of the master
};

/// The rate and the format of characters at the beginning of a text, `19200 8N1`, `baud=115200 parity=N`,
/// `"baudrate":19200`,
/// `{B19200 -parenb}` and `c_cflag=B19200|CS8` of strace; and a time-out, `timeout 500 ms`.
StatedLine stated_line(std::string_view bytes);

}  // namespace s7200::tools
