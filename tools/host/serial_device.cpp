#include "tools/host/serial_device.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "tools/host/termios2.hpp"

namespace s7200::tools {
namespace {

/// Documentation/admin-guide/devices.txt of Linux: the far sides of ptys.
bool is_pty(int fd) {
  struct stat status {};
  return fstat(fd, &status) == 0 && major(status.st_rdev) >= 136 && major(status.st_rdev) <= 143;
}

/// Why a device that was given the settings `wanted` does not have them. Rates are divided from a crystal: a receiver can
/// bear a difference of 2 %.
std::string refusal(const termios2& wanted, const termios2& taken, bool pty) {
  const auto far = [](speed_t rate, speed_t from) {
    return rate > from ? rate - from > from / 50 : from - rate > from / 50;
  };
  if (far(taken.c_ospeed, wanted.c_ospeed))
    return fmt::format("the device does not do {} baud (it offers {})", wanted.c_ospeed, taken.c_ospeed);
  const tcflag_t differs = wanted.c_cflag ^ taken.c_cflag;
  if ((differs & CSIZE) != 0)
    return fmt::format("the device does not do {} data bits", (wanted.c_cflag & CSIZE) == CS7 ? 7 : 8);
  if ((differs & (PARENB | PARODD)) != 0 && !pty) return "the device does not do this parity";
  if ((differs & CSTOPB) != 0) return "the device does not do 2 stop bits";
  return {};
}

std::string error_text() { return std::strerror(errno); }

}  // namespace

struct SerialDevice::Settings {
  termios2 value;
};

SerialDevice::SerialDevice(int fd, std::unique_ptr<Settings> found) : fd_(fd), found_(std::move(found)) {}

SerialDevice::SerialDevice(SerialDevice&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)), found_(std::move(other.found_)), format_(other.format_), mark_(other.mark_) {}

SerialDevice::~SerialDevice() {
  if (fd_ < 0) return;
  if (found_) write_settings(fd_, found_->value);
  ioctl(fd_, TIOCNXCL);
  close(fd_);
}

std::optional<SerialDevice> SerialDevice::open(const std::string& path, const SerialFormat& format, std::string& why) {
  SerialDevice device(::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC), nullptr);
  if (device.fd_ < 0) {
    why = errno == EBUSY ? "another program has it open" : error_text();
    return {};
  }
  termios2 found{};
  if (!read_settings(device.fd_, found)) {
    why = "it is not a serial device";
    return {};
  }
  if (flock(device.fd_, LOCK_EX | LOCK_NB) != 0) {
    why = "another program has locked it";
    return {};
  }
  ioctl(device.fd_, TIOCEXCL);
  device.found_ = std::make_unique<Settings>(Settings{found});
  if (!device.set(format, why)) return {};
  device.discard_input();
  return device;
}

bool SerialDevice::set(const SerialFormat& format, std::string& why) {
  termios2 before{}, wanted{}, taken{};
  if (!read_settings(fd_, before)) {
    why = error_text();
    return false;
  }
  wanted = before;
  make_raw(wanted);
  put_format(wanted, format);
  wanted.c_iflag |= PARMRK;
  // A pty shows that there is parity by this flag only; a device reports bad stop bits with it too.
  const bool checked = format.parity != Parity::None || !is_pty(fd_);
  wanted.c_iflag = checked ? wanted.c_iflag | INPCK : wanted.c_iflag & ~tcflag_t{INPCK};
  if (!write_settings(fd_, wanted) || !read_settings(fd_, taken)) {
    why = error_text();
    return false;
  }
  why = refusal(wanted, taken, is_pty(fd_));
  if (!why.empty()) {
    write_settings(fd_, before);
    return false;
  }
  format_ = format;
  return true;
}

bool SerialDevice::read(std::vector<Character>& characters, std::string& why) {
  std::array<std::uint8_t, kMostAtOnce> bytes{};
  ssize_t count = -1;
  do count = ::read(fd_, bytes.data(), bytes.size());
  while (count < 0 && errno == EINTR);
  if (count == 0 || (count < 0 && errno != EAGAIN)) {
    why = count == 0 ? "it was hung up" : error_text();
    return false;
  }
  for (ssize_t i = 0; i < count; ++i) take(bytes[static_cast<std::size_t>(i)], characters);
  return true;
}

void SerialDevice::take(std::uint8_t byte, std::vector<Character>& characters) {
  switch (mark_) {
    case Mark::None:
      if (byte == 0xFF)
        mark_ = Mark::Begun;
      else
        characters.push_back({byte, false});
      return;
    case Mark::Begun:
      mark_ = byte == 0 ? Mark::Error : Mark::None;
      if (byte != 0) characters.push_back({byte, false});
      return;
    case Mark::Error:
      mark_ = Mark::None;
      characters.push_back({byte, true});
      return;
  }
}

std::optional<std::size_t> SerialDevice::write(std::span<const std::uint8_t> bytes, std::string& why) {
  for (;;) {
    const ssize_t count = ::write(fd_, bytes.data(), bytes.size());
    if (count >= 0) return static_cast<std::size_t>(count);
    if (errno == EAGAIN) return 0;
    if (errno == EINTR) continue;
    why = error_text();
    return {};
  }
}

void SerialDevice::discard_input() {
  ioctl(fd_, TCFLSH, TCIFLUSH);
  mark_ = Mark::None;
}

}  // namespace s7200::tools
