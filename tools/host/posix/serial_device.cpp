#include "tools/host/serial_device.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "interpreter/base/result.hpp"
#include "tools/host/posix/termios2.hpp"

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

bool names_serial_device(const std::string& word) {
  std::error_code none;
  return word.starts_with("/dev/tty") || std::filesystem::is_character_file(word, none);
}

std::string_view example_of_serial_device() { return "/dev/ttyUSB0"; }

bool has_ptys() { return true; }

struct SerialDevice::System {
  explicit System(int descriptor) : fd(descriptor) {}
  ~System() {
    if (fd < 0) return;
    if (found) write_settings(fd, *found);
    ioctl(fd, TIOCNXCL);
    close(fd);
  }
  System(const System&) = delete;
  System& operator=(const System&) = delete;

  bool wait_for(short events, std::chrono::nanoseconds at_most) const {
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(at_most);
    const timespec timeout{seconds.count(), static_cast<long>((at_most - seconds).count())};
    pollfd waiting{fd, events, 0};
    return ppoll(&waiting, 1, &timeout, nullptr) > 0;
  }

  void take(std::uint8_t byte, std::vector<Character>& characters);

  const int fd;
  std::optional<termios2> found;  // the settings
  /// Characters with errors come as FF 00 and the character, FF itself as FF FF (PARMRK, termios(3)).
  enum class Mark : std::uint8_t { None, Begun, Error } mark = Mark::None;
};

SerialDevice::SerialDevice() = default;
SerialDevice::SerialDevice(SerialDevice&& other) noexcept = default;
SerialDevice::~SerialDevice() = default;

Result<SerialDevice> SerialDevice::open(const std::string& path, const SerialFormat& format) {
  SerialDevice device;
  device.system_ = std::make_unique<System>(::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  const int fd = device.system_->fd;
  if (fd < 0) return Trouble{errno == EBUSY ? "another program has it open" : error_text()};
  termios2 found{};
  if (!read_settings(fd, found)) return Trouble{"it is not a serial device"};
  if (flock(fd, LOCK_EX | LOCK_NB) != 0) return Trouble{"another program has locked it"};
  ioctl(fd, TIOCEXCL);
  device.system_->found = found;
  if (const auto done = device.set(format); !done) return done.trouble();
  device.discard_input();
  return device;
}

Result<> SerialDevice::set(const SerialFormat& format) {
  const int fd = system_->fd;
  termios2 before{}, wanted{}, taken{};
  if (!read_settings(fd, before)) return Trouble{error_text()};
  wanted = before;
  make_raw(wanted);
  put_format(wanted, format);
  wanted.c_iflag |= PARMRK;
  // A pty shows that there is parity by this flag only; a device reports bad stop bits with it too.
  const bool checked = format.parity != Parity::None || !is_pty(fd);
  wanted.c_iflag = checked ? wanted.c_iflag | INPCK : wanted.c_iflag & ~tcflag_t{INPCK};
  if (!write_settings(fd, wanted) || !read_settings(fd, taken)) return Trouble{error_text()};
  if (std::string why = refusal(wanted, taken, is_pty(fd)); !why.empty()) {
    write_settings(fd, before);
    return Trouble{std::move(why)};
  }
  format_ = format;
  return {};
}

Result<> SerialDevice::read(std::vector<Character>& characters) {
  std::array<std::uint8_t, kMostAtOnce> bytes{};
  ssize_t count = -1;
  do count = ::read(system_->fd, bytes.data(), bytes.size());
  while (count < 0 && errno == EINTR);
  if (count == 0 || (count < 0 && errno != EAGAIN)) return Trouble{count == 0 ? "it was hung up" : error_text()};
  for (ssize_t i = 0; i < count; ++i) system_->take(bytes[static_cast<std::size_t>(i)], characters);
  return {};
}

void SerialDevice::System::take(std::uint8_t byte, std::vector<Character>& characters) {
  switch (mark) {
    case Mark::None:
      if (byte == 0xFF)
        mark = Mark::Begun;
      else
        characters.push_back({byte, false});
      return;
    case Mark::Begun:
      mark = byte == 0 ? Mark::Error : Mark::None;
      if (byte != 0) characters.push_back({byte, false});
      return;
    case Mark::Error:
      mark = Mark::None;
      characters.push_back({byte, true});
      return;
  }
}

std::intptr_t SerialDevice::native() const { return system_->fd; }

bool SerialDevice::wait_for_input(std::chrono::nanoseconds at_most) const { return system_->wait_for(POLLIN, at_most); }

bool SerialDevice::wait_for_room(std::chrono::nanoseconds at_most) const { return system_->wait_for(POLLOUT, at_most); }

bool SerialDevice::drive_dtr(bool high) {
  const int lines = TIOCM_DTR;
  return ioctl(system_->fd, high ? TIOCMBIS : TIOCMBIC, &lines) == 0;
}

void SerialDevice::drain() { ioctl(system_->fd, TCSBRK, 1); }

Result<std::size_t> SerialDevice::write(std::span<const std::uint8_t> bytes) {
  for (;;) {
    const ssize_t count = ::write(system_->fd, bytes.data(), bytes.size());
    if (count >= 0) return static_cast<std::size_t>(count);
    if (errno == EAGAIN) return 0;
    if (errno == EINTR) continue;
    return Trouble{error_text()};
  }
}

void SerialDevice::discard_input() {
  ioctl(system_->fd, TCFLSH, TCIFLUSH);
  system_->mark = System::Mark::None;
}

}  // namespace s7200::tools
