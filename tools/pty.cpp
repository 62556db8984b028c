#include "tools/pty.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <stdlib.h>
#include <sys/inotify.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "tools/termios2.hpp"

namespace s7200::tools {
namespace fs = std::filesystem;
namespace {

/// Makes the port wait for a carrier, which a pty has not: without effect, but each program that opens a serial port takes
/// it back. So its tcsetattr() changes something, without which the C library reports EINVAL when a pty drops the parity
/// asked for, and pyserial gives up. Only this bit is touched: a program may be setting the others.
void leave_something_to_change(int far) {
  const int without_carrier = 0;
  ioctl(far, TIOCSSOFTCAR, &without_carrier);
}

/// What our links hold: `/dev/pts/./3`, which is /dev/pts/3 in a spelling that nobody else uses. A link has no other room
/// for a mark: extended attributes are for files and folders only (xattr(7)).
std::string marked(const fs::path& path) { return (path.parent_path() / "." / path.filename()).string(); }

/// Whether a run that is over has left this link: it is one of ours and leads nowhere. Or it leads to `path`, the pty that
/// this run has just got: its number was free, so that the run that made the link has gone.
bool is_left_behind(const std::string& link, const std::string& path) {
  std::error_code error;
  const std::string target = fs::read_symlink(link, error).string();
  const fs::path leads_to = fs::path(target).lexically_normal();
  if (error || leads_to.parent_path() != fs::path(path).parent_path() || target != marked(leads_to)) return false;
  return !fs::exists(link, error) || target == marked(path);
}

}  // namespace

std::unique_ptr<Pty> Pty::open(const std::string& link, const SerialFormat& format, std::string& why) {
  std::unique_ptr<Pty> pty(new Pty);
  if (!pty->open_far_side(format, why)) {
    why = fmt::format("cannot open a pty: {}", why);
    return nullptr;
  }
  if (!pty->make_link(link, why)) return nullptr;
  return pty;
}

Pty::~Pty() {
  std::error_code none;
  if (!link_.empty() && fs::read_symlink(link_, none) == marked(path_)) fs::remove(link_, none);
  for (const int fd : {watch_, far_, fd_})
    if (fd >= 0) close(fd);
}

/// The far side stays open here too, so that the near one never hangs up. Who else opens it is told by inotify, which
/// watches before anybody can. Its queue merges an event with an equal one right before it (inotify(7)), and so loses count
/// of who opens it twice; with the folder watched too, an event of the folder stands between each two of the far side.
bool Pty::open_far_side(const SerialFormat& format, std::string& why) {
  std::array<char, 64> name{};
  termios2 settings{};
  fd_ = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  bool done = fd_ >= 0 && grantpt(fd_) == 0 && ptsname_r(fd_, name.data(), name.size()) == 0 && unlockpt(fd_) == 0;
  if (done) {
    path_ = name.data();
    far_ = ::open(path_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    done = far_ >= 0 && read_settings(far_, settings);
  }
  if (done) {
    make_raw(settings);
    put_format(settings, format);
    watch_ = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
    const auto watch = [this](const std::string& path) {
      return inotify_add_watch(watch_, path.c_str(), IN_OPEN | IN_CLOSE);
    };
    done = write_settings(far_, settings) && watch_ >= 0 && (far_watch_ = watch(path_)) >= 0 &&
           watch(fs::path(path_).parent_path()) >= 0;
  }
  if (!done) why = std::strerror(errno);
  leave_something_to_change(far_);
  return done;
}

bool Pty::make_link(const std::string& link, std::string& why) {
  std::error_code error;
  const fs::file_status found = fs::symlink_status(link, error);
  if (is_left_behind(link, path_)) {
    fs::remove(link, error);
  } else if (fs::exists(found)) {
    why = fs::is_symlink(found)
              ? fmt::format("{} exists and leads to {}; it is left alone", link, fs::read_symlink(link, error).string())
              : fmt::format("{} exists and is not a link; it is left alone", link);
    return false;
  }
  if (symlink(marked(path_).c_str(), link.c_str()) != 0) {
    why = fmt::format("cannot make the link {}: {}", link, std::strerror(errno));
    return false;
  }
  link_ = fs::absolute(link, error).string();
  return true;
}

PtySettings Pty::settings() const {
  PtySettings settings;
  termios2 far{};
  if (!read_settings(fd_, far)) return settings;
  settings.baud = (far.c_cflag & CBAUD) == B0 ? 0 : far.c_ospeed;
  settings.stop_bits = (far.c_cflag & CSTOPB) != 0 ? 2 : 1;
  settings.checks_parity = (far.c_iflag & INPCK) != 0;
  settings.ignores_errors = (far.c_iflag & IGNPAR) != 0;
  if ((far.c_cflag & PARODD) != 0)
    settings.parity = Parity::Odd;
  else if (settings.checks_parity)
    settings.parity = Parity::Even;
  return settings;
}

void Pty::look() {
  alignas(inotify_event) std::array<char, 4096> buffer;
  for (;;) {
    const ssize_t count = read(watch_, buffer.data(), buffer.size());
    if (count <= 0) return keep_changeable();
    bool left = false;
    for (const char* next = buffer.data(); next < buffer.data() + count;) {
      const auto* event = reinterpret_cast<const inotify_event*>(next);
      next += sizeof(inotify_event) + event->len;
      if ((event->mask & IN_Q_OVERFLOW) != 0) open_now_ = std::max(open_now_, 1);  // what is lost: somebody may have come
      if (event->wd != far_watch_) continue;
      if ((event->mask & IN_OPEN) != 0) {
        ++open_now_;
        ++opened_;
      }
      if ((event->mask & IN_CLOSE) != 0 && open_now_ != 0 && --open_now_ == 0) left = true;
    }
    if (left) all_have_left();
  }
}

/// A program that keeps the port open may set it again.
void Pty::keep_changeable() const {
  termios2 settings{};
  if (read_settings(far_, settings) && (settings.c_cflag & CLOCAL) != 0) leave_something_to_change(far_);
}

/// What was not read lies in two places: behind the near side's output, and in the far side's input.
void Pty::all_have_left() const {
  ioctl(fd_, TCFLSH, TCOFLUSH);
  ioctl(far_, TCFLSH, TCIFLUSH);
  ioctl(far_, TIOCNXCL);
}

}  // namespace s7200::tools
