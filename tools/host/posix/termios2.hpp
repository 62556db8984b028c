// Settings of a Linux terminal line, with any baud rate. <termios.h> knows only listed rates and cannot be included beside
// the kernel's own declarations, which are needed for the others (tcgetattr(3), TCGETS2 in ioctl_tty(2)).
#pragma once

#include <asm/termbits.h>

#include "interpreter/base/serial_format.hpp"

namespace s7200::tools {

/// Read and write settings. Return false and set errno when `fd` is not a terminal line or is gone. On the controlling side
/// of a pty both work on the other side.
bool read_settings(int fd, termios2& settings);
bool write_settings(int fd, const termios2& settings);

/// Sets raw mode: no echo, no lines, no characters with a meaning, no flow control; what is read is there at once.
void make_raw(termios2& settings);

void put_format(termios2& settings, const SerialFormat& format);

}  // namespace s7200::tools
