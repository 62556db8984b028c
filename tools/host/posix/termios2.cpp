#include "tools/host/posix/termios2.hpp"

#include <sys/ioctl.h>

#include <algorithm>
#include <array>

namespace s7200::tools {
namespace {

/// The rates that have a code of their own, for programs that know no others.
tcflag_t code_of(std::uint32_t baud) {
  struct Rate {
    std::uint32_t baud;
    tcflag_t code;
  };
  static constexpr std::array<Rate, 13> kRates{{{50, B50},
                                                {75, B75},
                                                {110, B110},
                                                {150, B150},
                                                {300, B300},
                                                {600, B600},
                                                {1200, B1200},
                                                {2400, B2400},
                                                {4800, B4800},
                                                {9600, B9600},
                                                {19200, B19200},
                                                {38400, B38400},
                                                {115200, B115200}}};
  const auto rate = std::find_if(kRates.begin(), kRates.end(), [baud](const Rate& r) { return r.baud == baud; });
  return rate == kRates.end() ? BOTHER : rate->code;
}

}  // namespace

bool read_settings(int fd, termios2& settings) { return ioctl(fd, TCGETS2, &settings) == 0; }

bool write_settings(int fd, const termios2& settings) { return ioctl(fd, TCSETS2, &settings) == 0; }

void make_raw(termios2& settings) {
  settings.c_iflag &= ~tcflag_t{IGNBRK | BRKINT | IGNPAR | PARMRK | INPCK | ISTRIP | INLCR | IGNCR | ICRNL | IXON | IXOFF};
  settings.c_oflag &= ~tcflag_t{OPOST};
  settings.c_lflag &= ~tcflag_t{ECHO | ECHONL | ICANON | ISIG | IEXTEN};
  settings.c_cflag &= ~tcflag_t{CRTSCTS};
  settings.c_cflag |= CREAD | CLOCAL;
  settings.c_cc[VMIN] = 1;
  settings.c_cc[VTIME] = 0;
}

void put_format(termios2& settings, const SerialFormat& format) {
  settings.c_cflag &= ~tcflag_t{CBAUD | CIBAUD | CSIZE | PARENB | PARODD | CMSPAR | CSTOPB};
  settings.c_cflag |= code_of(format.baud) | code_of(format.baud) << IBSHIFT;
  settings.c_ospeed = settings.c_ispeed = format.baud;
  settings.c_cflag |= format.data_bits == 7 ? CS7 : CS8;
  if (format.parity != Parity::None) settings.c_cflag |= PARENB;
  if (format.parity == Parity::Odd) settings.c_cflag |= PARODD;
  if (format.stop_bits == 2) settings.c_cflag |= CSTOPB;
}

}  // namespace s7200::tools
