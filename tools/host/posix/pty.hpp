// A pty that stands for a serial port: its far side has a stable name, and programs open it like /dev/ttyS0.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "interpreter/base/result.hpp"
#include "interpreter/base/serial_format.hpp"

namespace s7200::tools {

/// How the program on the far side has set its port. The pty driver of Linux keeps rate, stop bits, PARODD and the input
/// flags; it always clears PARENB and CSIZE (drivers/tty/pty.c, pty_set_termios), so that no parity, and even parity without
/// INPCK, look the same, and 7 data bits are refused.
struct PtySettings {
  std::uint32_t baud = 0;        ///< 0: hung up
  std::optional<Parity> parity;  ///< where it can be told: PARODD, or INPCK without it
  std::uint8_t stop_bits = 1;
  bool checks_parity = false;   ///< INPCK
  bool ignores_errors = false;  ///< IGNPAR

  bool operator==(const PtySettings&) const = default;
};

/// A name that leads to one of several ptys.
///
/// The C library of Debian asks a pty how it is set before and after it sets it, and tells the program EINVAL when that is
/// the same although the program has asked for parity. So a port has to be set a little differently from what a program
/// will ask for, and must not be set at all while a program may be between the two questions. Therefore no one sets a port
/// that a program has open: each program gets one for itself, that was made ready before, because the name leads to another
/// as soon as one is opened. A thread of its own sees to that, some ten microseconds later, whatever else is going on.
class Pty {
 public:
  class Port {
   public:
    ~Port();
    Port(const Port&) = delete;
    Port& operator=(const Port&) = delete;

    /// The near side: bytes that a program writes on the far side are read here, and the other way round. It never blocks
    /// and never hangs up.
    int fd() const { return fd_; }

    /// The settings of the port; after a program has left, they are as it left them.
    PtySettings settings() const;

    int open_now() const { return open_now_; }          ///< how many have it open, as of look()
    std::uint64_t session() const { return session_; }  ///< another each time it is opened after all have left; 0 before

    /// Bytes that a program wrote and that wait to be read here, as far as they have come.
    std::size_t unread() const;

   private:
    friend class Pty;
    Port() = default;
    Result<> open(int watch);
    PtySettings settings_now() const;
    void all_have_left();
    void keep_changeable();

    int fd_ = -1, far_ = -1, far_watch_ = -1;
    std::string path_;
    std::atomic<int> open_now_ = 0;
    std::atomic<std::uint64_t> session_ = 0;
    mutable std::mutex mutex_;  ///< guards left_as_ and set_since_
    std::optional<PtySettings> left_as_;
    std::optional<std::chrono::steady_clock::time_point> set_since_;
  };

  /// Opens ptys, raw and with the settings of `format` until a program changes them. `link` becomes a symbolic link to a far
  /// side. Trouble when that cannot be done: whatever exists under that name is left alone, but a link that a
  /// run like this one made and, because it was killed, did not remove. Our links are known by how they spell their target:
  /// `/dev/pts/./3`.
  static Result<std::unique_ptr<Pty>> open(const std::string& link, const SerialFormat& format);

  /// Removes the link if it still is ours.
  ~Pty();
  Pty(const Pty&) = delete;
  Pty& operator=(const Pty&) = delete;

  /// Ports stay where they are; more come when all are in use.
  std::size_t port_count() const;
  const Port& port(std::size_t index) const;

  /// The one that was opened last, or before that the one that will be opened.
  const Port& latest() const;
  PtySettings settings() const { return latest().settings(); }

  /// Looks who has come and gone by now. When the last one has left a port, what it did not read is forgotten, as a serial
  /// port does when it is closed, and what it set holds for who comes next. To be called often.
  void look();

  int open_now() const;                                  ///< of all ports
  std::uint64_t opened_ever() const { return opened_; }  ///< how often one was opened

 private:
  struct Settings;  // all of a port's

  Pty();
  Result<> add_port();
  Result<> make_link(const std::string& link);
  bool leads_to_us(const std::string& link) const;
  bool is_left_behind(const std::string& link) const;
  void make_ready(const Port& port);
  void take_events();
  void opened(std::size_t index);
  void closed(std::size_t index);
  void offer_another();
  std::size_t free_port();
  void keep_offering();

  mutable std::mutex mutex_;  ///< guards all members that are not atomic
  int watch_ = -1, end_ = -1;
  std::deque<std::unique_ptr<Port>> ports_;
  std::size_t offered_ = 0, latest_ = 0;  ///< where the link leads; which was opened last
  bool taken_ = false;                    ///< that one has been opened since
  std::string link_;
  std::unique_ptr<Settings> settings_, offered_with_;  ///< what was set last; what the offered port was made ready with
  std::atomic<std::uint64_t> opened_ = 0;
  std::thread keeper_;
};

}  // namespace s7200::tools
