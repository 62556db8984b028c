// A pty that stands for a serial port: its far side has a stable name, and programs open it like /dev/ttyS0.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "interpreter/base/serial_format.hpp"

namespace s7200::tools {

/// How the program on the far side has set its port. The pty driver of Linux keeps rate, stop bits, PARODD and the input
/// flags; it always clears PARENB and CSIZE (drivers/tty/pty.c, pty_set_termios), so that no parity, and even parity without
/// INPCK, look the same, and 7 data bits are refused.
///
/// The C library tells a program EINVAL when nothing at all has changed by what it asked for, and parity alone never
/// changes. So that a program can set its port as often as it likes, two flags without effect are set again when they were
/// cleared.
struct PtySettings {
  std::uint32_t baud = 0;        ///< 0: hung up
  std::optional<Parity> parity;  ///< where it can be told: PARODD, or INPCK without it
  std::uint8_t stop_bits = 1;
  bool checks_parity = false;   ///< INPCK
  bool ignores_errors = false;  ///< IGNPAR

  bool operator==(const PtySettings&) const = default;
};

class Pty {
 public:
  /// Opens a pty, raw and with the settings of `format` until a program changes them. `link` becomes a symbolic link to its
  /// far side. Nothing, and `why`, when that cannot be done: whatever exists under that name is left alone, but a link that
  /// a run like this one made and, because it was killed, did not remove. Our links are known by how they spell their
  /// target:
  /// `/dev/pts/./3`.
  static std::unique_ptr<Pty> open(const std::string& link, const SerialFormat& format, std::string& why);

  /// Removes the link if it still is ours.
  ~Pty();
  Pty(const Pty&) = delete;
  Pty& operator=(const Pty&) = delete;

  /// What a program on the far side writes is read here, and the other way round. It never blocks and never hangs up.
  int fd() const { return fd_; }

  /// `/dev/pts/3`
  const std::string& path() const { return path_; }

  PtySettings settings() const;

  /// To be called often: looks who has come and gone. When the last one has left, what it did not read is forgotten, as a
  /// serial port does when it is closed.
  void look();

  /// Readable when look() has something to see.
  int watch() const { return watch_; }

  int open_now() const { return open_now_; }             ///< how many have the far side open, as of look()
  std::uint64_t opened_ever() const { return opened_; }  ///< how often it was opened

 private:
  Pty() = default;
  bool open_far_side(const SerialFormat& format, std::string& why);
  bool make_link(const std::string& link, std::string& why);
  void keep_changeable() const;
  void all_have_left() const;

  int fd_ = -1, far_ = -1, watch_ = -1, far_watch_ = -1;
  std::string path_, link_;
  int open_now_ = 0;
  std::uint64_t opened_ = 0;
};

}  // namespace s7200::tools
