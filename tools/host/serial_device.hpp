// A serial device of this computer: /dev/ttyS0, a USB adapter, or the far side of a pty.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "interpreter/base/serial_format.hpp"

namespace s7200::tools {

class SerialDevice {
 public:
  struct Character {
    std::uint8_t byte = 0;
    bool error = false;  ///< wrong parity, no stop bit, or a break: Linux does not say which
    bool operator==(const Character&) const = default;
  };

  /// Opens a device for this process alone, raw and without flow control; what came in before is forgotten. Nothing, and
  /// `why`, when that cannot be done or the device does not take the format. A pty takes every format with 8 data bits and
  /// has no parity.
  static std::optional<SerialDevice> open(const std::string& path, const SerialFormat& format, std::string& why);

  /// Restores the device's settings.
  ~SerialDevice();
  SerialDevice(SerialDevice&& other) noexcept;
  SerialDevice& operator=(SerialDevice&&) = delete;

  /// Another format from now on, for what is still to be sent too. False, and `why`, when the device does not take it; the
  /// old one then holds.
  bool set(const SerialFormat& format, std::string& why);
  const SerialFormat& format() const { return format_; }

  /// The descriptor for poll(2); it never blocks.
  int fd() const { return fd_; }

  /// Appends what has come in, at most kMostAtOnce characters: a side that never stops sending blocks nothing. Returns false
  /// and sets `why` when the device is gone.
  static constexpr std::size_t kMostAtOnce = 4096;
  bool read(std::vector<Character>& characters, std::string& why);

  /// Writes bytes. Returns how many were taken, 0 when none can be taken just now. Nothing, with `why` set, when the device
  /// is gone.
  std::optional<std::size_t> write(std::span<const std::uint8_t> bytes, std::string& why);

  /// Forgets what has come in and was not read.
  void discard_input();

 private:
  struct Settings;  // as they were found

  SerialDevice(int fd, std::unique_ptr<Settings> found);
  void take(std::uint8_t byte, std::vector<Character>& characters);

  int fd_;
  std::unique_ptr<Settings> found_;
  SerialFormat format_;
  /// Characters with errors come as FF 00 and the character, FF itself as FF FF (PARMRK, termios(3)).
  enum class Mark : std::uint8_t { None, Begun, Error } mark_ = Mark::None;
};

}  // namespace s7200::tools
