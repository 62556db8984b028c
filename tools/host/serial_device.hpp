// A serial device of this computer: /dev/ttyS0, a USB adapter, or the far side of a pty; on Windows a COM port.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/result.hpp"
#include "interpreter/base/serial_format.hpp"

namespace s7200::tools {

/// Whether a word names a serial device rather than anything else: /dev/tty…, the far side of a pty, COM3, \\.\COM12.
bool names_serial_device(const std::string& word);

/// How help texts name one: `/dev/ttyUSB0`, `COM3`.
std::string_view example_of_serial_device();

/// Whether this system has ptys; Windows has none.
bool has_ptys();

class SerialDevice {
 public:
  struct Character {
    std::uint8_t byte = 0;
    /// Wrong parity, no stop bit, or a break: the systems do not say which. Windows does not say at which character either:
    /// it is the last of those that had come in when the error was told.
    bool error = false;
    bool operator==(const Character&) const = default;
  };

  /// Opens a device for this process alone, raw and without flow control; what came in before is forgotten. Trouble
  /// when that cannot be done or the device does not take the format. A pty takes every format with 8 data bits and
  /// has no parity.
  static Result<SerialDevice> open(const std::string& path, const SerialFormat& format);

  /// Restores the device's settings.
  ~SerialDevice();
  SerialDevice(SerialDevice&& other) noexcept;
  SerialDevice& operator=(SerialDevice&&) = delete;

  /// Another format from now on, for what is still to be sent too. Trouble when the device does not take it; the
  /// old one then holds.
  Result<> set(const SerialFormat& format);
  const SerialFormat& format() const { return format_; }

  /// What a loop waits for: a descriptor for poll(2) that never blocks; on Windows the handle of an event that is set while
  /// there is something to read.
  std::intptr_t native() const;

  /// Whether there is something to read, the end too, or room to write, within that time.
  bool wait_for_input(std::chrono::nanoseconds at_most) const;
  bool wait_for_room(std::chrono::nanoseconds at_most) const;

  /// Drives DTR. Returns false where there is none.
  bool drive_dtr(bool high);

  /// Returns when what was written is on its way.
  void drain();

  /// Appends what has come in, at most kMostAtOnce characters: a side that never stops sending blocks nothing. Trouble
  /// when the device is gone.
  static constexpr std::size_t kMostAtOnce = 4096;
  Result<> read(std::vector<Character>& characters);

  /// Writes bytes. Returns how many were taken, 0 when none can be taken just now. Trouble when the device
  /// is gone.
  Result<std::size_t> write(std::span<const std::uint8_t> bytes);

 private:
  struct System;  // the device as the system sees it

  SerialDevice();

  /// Forgets what has come in and was not read. For a device that is being opened: nobody reads yet.
  void discard_input();

  std::unique_ptr<System> system_;
  SerialFormat format_;
};

}  // namespace s7200::tools
