#include "tools/host/posix/pty.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/eventfd.h>
#include <sys/inotify.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <numeric>

#include "tools/host/posix/termios2.hpp"

namespace s7200::tools {
namespace fs = std::filesystem;
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kPorts = 4;  // to begin with: a next one is ready, however fast programs come and go
constexpr std::size_t kMostPorts = 64;

/// After a program has set its port, a further setting after this time is another call of tcsetattr().
constexpr std::chrono::seconds kSettled{1};

/// Two flags without effect on a raw pty, the other way round from what programs set: a carrier to wait for, and characters
/// with a meaning in lines. One of them is then changed by whoever sets the port.
void leave_something_to_change(termios2& settings) {
  settings.c_cflag &= ~tcflag_t{CLOCAL};
  settings.c_lflag |= IEXTEN;
}

/// Whether the settings are the same but for those two flags.
bool same(termios2 one, termios2 other) {
  leave_something_to_change(one);
  leave_something_to_change(other);
  return one.c_iflag == other.c_iflag && one.c_oflag == other.c_oflag && one.c_cflag == other.c_cflag &&
         one.c_lflag == other.c_lflag && one.c_ospeed == other.c_ospeed && std::ranges::equal(one.c_cc, other.c_cc);
}

/// The target of our links: `/dev/pts/./3`, which is /dev/pts/3 in a spelling that nothing else uses. A link has no other
/// room for a mark: extended attributes are for files and folders only (xattr(7)).
std::string marked(const fs::path& path) { return (path.parent_path() / "." / path.filename()).string(); }

}  // namespace

struct Pty::Settings {
  termios2 value{};
};

// --- one of the ptys ---

Pty::Port::~Port() {
  for (const int fd : {far_, fd_})
    if (fd >= 0) close(fd);
}

/// The far side stays open here too, so that the near one never hangs up. Who else opens it is told by inotify, which
/// watches before anyone can.
Result<> Pty::Port::open(int watch) {
  std::array<char, 64> name{};
  fd_ = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  bool done = fd_ >= 0 && grantpt(fd_) == 0 && ptsname_r(fd_, name.data(), name.size()) == 0 && unlockpt(fd_) == 0;
  if (done) {
    path_ = name.data();
    far_ = ::open(path_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    far_watch_ = inotify_add_watch(watch, path_.c_str(), IN_OPEN | IN_CLOSE);
    done = far_ >= 0 && far_watch_ >= 0;
  }
  if (!done) return trouble("cannot open a pty: {}", std::strerror(errno));
  return {};
}

PtySettings Pty::Port::settings() const {
  const std::lock_guard lock(mutex_);
  return left_as_ ? *left_as_ : settings_now();
}

PtySettings Pty::Port::settings_now() const {
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

std::size_t Pty::Port::unread() const {
  int count = 0;
  return ioctl(fd_, FIONREAD, &count) == 0 ? static_cast<std::size_t>(count) : 0;
}

/// Drops unread bytes, which are in two places: after the near side's output, and in the far side's input.
void Pty::Port::all_have_left() {
  {
    const std::lock_guard lock(mutex_);
    left_as_ = settings_now();
  }
  ioctl(fd_, TCFLSH, TCOFLUSH);
  ioctl(far_, TCFLSH, TCIFLUSH);
  ioctl(far_, TIOCNXCL);
}

/// A program that keeps its port open may set it again later. Only one bit is touched: it may be setting the others.
void Pty::Port::keep_changeable() {
  int without_carrier = 0;
  if (open_now_ == 0 || ioctl(far_, TIOCGSOFTCAR, &without_carrier) != 0 || without_carrier == 0) return set_since_.reset();
  if (!set_since_) set_since_ = Clock::now();
  if (Clock::now() - *set_since_ < kSettled) return;
  without_carrier = 0;
  ioctl(far_, TIOCSSOFTCAR, &without_carrier);
}

// --- the name ---

Pty::Pty() : settings_(std::make_unique<Settings>()), offered_with_(std::make_unique<Settings>()) {}

/// The queue of inotify merges an event with an equal one right before it (inotify(7)), and so would lose count of who opens
/// a port twice; with the folder watched too, an event of the folder stands between each two of a port.
Result<std::unique_ptr<Pty>> Pty::open(const std::string& link, const SerialFormat& format) {
  std::unique_ptr<Pty> pty(new Pty);
  pty->watch_ = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
  pty->end_ = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  for (std::size_t i = 0; i < kPorts; ++i)
    if (const auto done = pty->add_port(); !done) return done.trouble();
  const fs::path folder = fs::path(pty->ports_[0]->path_).parent_path();
  termios2& settings = pty->settings_->value;
  if (inotify_add_watch(pty->watch_, folder.c_str(), IN_OPEN | IN_CLOSE) < 0 ||
      !read_settings(pty->ports_[0]->far_, settings))
    return trouble("cannot open a pty: {}", std::strerror(errno));
  make_raw(settings);
  put_format(settings, format);
  pty->make_ready(*pty->ports_[0]);
  if (const auto done = pty->make_link(link); !done) return done.trouble();
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);  // signals are for the other threads
  pty->keeper_ = std::thread([&pty = *pty] { pty.keep_offering(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return pty;
}

Pty::~Pty() {
  if (keeper_.joinable()) {
    eventfd_write(end_, 1);
    keeper_.join();
  }
  std::error_code none;
  if (!link_.empty() && leads_to_us(link_)) fs::remove(link_, none);
  for (const int fd : {end_, watch_})
    if (fd >= 0) close(fd);
}

void Pty::keep_offering() {
  std::array<pollfd, 2> waiting{{{watch_, POLLIN, 0}, {end_, POLLIN, 0}}};
  while (poll(waiting.data(), waiting.size(), -1) >= 0 && waiting[1].revents == 0) look();
}

Result<> Pty::add_port() {
  std::unique_ptr<Port> port(new Port);
  if (const auto done = port->open(watch_); !done) return done.trouble();
  ports_.push_back(std::move(port));
  return {};
}

bool Pty::leads_to_us(const std::string& link) const {
  std::error_code none;
  const std::string target = fs::read_symlink(link, none).string();
  return std::ranges::any_of(ports_, [&](const auto& port) { return marked(port->path_) == target; });
}

/// Whether a run that is over has left this link: it is marked and leads nowhere. Or it leads to one of the ptys that this
/// run has just got: its number was free, so that the run that made the link has gone.
bool Pty::is_left_behind(const std::string& link) const {
  std::error_code error;
  const std::string target = fs::read_symlink(link, error).string();
  const fs::path leads_to = fs::path(target).lexically_normal();
  if (error || leads_to.parent_path() != fs::path(ports_[0]->path_).parent_path() || target != marked(leads_to))
    return false;
  return !fs::exists(link, error) || leads_to_us(link);
}

/// Makes a port ready that no program has open or is about to open.
void Pty::make_ready(const Port& port) {
  *offered_with_ = *settings_;
  termios2 settings = settings_->value;
  leave_something_to_change(settings);
  write_settings(port.far_, settings);
}

Result<> Pty::make_link(const std::string& link) {
  std::error_code error;
  const fs::file_status found = fs::symlink_status(link, error);
  if (is_left_behind(link)) {
    fs::remove(link, error);
  } else if (fs::exists(found)) {
    return Trouble{fs::is_symlink(found) ? fmt::format("{} exists and leads to {}; it is left alone", link,
                                                       fs::read_symlink(link, error).string())
                                         : fmt::format("{} exists and is not a link; it is left alone", link)};
  }
  if (symlink(marked(ports_[offered_]->path_).c_str(), link.c_str()) != 0)
    return trouble("cannot make the link {}: {}", link, std::strerror(errno));
  link_ = fs::absolute(link, error).string();
  return {};
}

std::size_t Pty::port_count() const {
  const std::lock_guard lock(mutex_);
  return ports_.size();
}

const Pty::Port& Pty::port(std::size_t index) const {
  const std::lock_guard lock(mutex_);
  return *ports_[index];
}

const Pty::Port& Pty::latest() const {
  const std::lock_guard lock(mutex_);
  return *ports_[latest_];
}

int Pty::open_now() const {
  const std::lock_guard lock(mutex_);
  return std::accumulate(ports_.begin(), ports_.end(), 0, [](int sum, const auto& port) { return sum + port->open_now_; });
}

void Pty::look() {
  const std::lock_guard lock(mutex_);
  take_events();
  if (taken_ || !same(settings_->value, offered_with_->value)) offer_another();
  for (const auto& port : ports_) port->keep_changeable();
}

void Pty::take_events() {
  alignas(inotify_event) std::array<char, 4096> buffer;
  for (;;) {
    const ssize_t count = read(watch_, buffer.data(), buffer.size());
    if (count <= 0) return;
    for (const char* next = buffer.data(); next < buffer.data() + count;) {
      const auto* event = reinterpret_cast<const inotify_event*>(next);
      next += sizeof(inotify_event) + event->len;
      const bool lost = (event->mask & IN_Q_OVERFLOW) != 0;  // someone may have come
      if (lost && ports_[offered_]->open_now_ == 0) opened(offered_);
      for (std::size_t i = 0; i < ports_.size(); ++i) {
        if (ports_[i]->far_watch_ != event->wd) continue;
        if ((event->mask & IN_OPEN) != 0) opened(i);
        if ((event->mask & IN_CLOSE) != 0) closed(i);
      }
    }
  }
}

void Pty::opened(std::size_t index) {
  Port& port = *ports_[index];
  ++opened_;
  if (port.open_now_++ == 0) {
    port.session_ = opened_.load();
    const std::lock_guard lock(port.mutex_);
    port.left_as_.reset();
  }
  latest_ = index;
  taken_ |= index == offered_;
}

/// A port that all programs have left keeps their settings until it is made ready for another program.
void Pty::closed(std::size_t index) {
  Port& port = *ports_[index];
  if (port.open_now_ == 0 || --port.open_now_ > 0) return;
  port.all_have_left();
  read_settings(port.far_, settings_->value);
}

/// Ports are taken in turn, so that one that was just left rests longest: a program may have been about to open it.
std::size_t Pty::free_port() {
  for (std::size_t step = 1; step < ports_.size(); ++step) {
    const std::size_t index = (offered_ + step) % ports_.size();
    if (ports_[index]->open_now_ == 0 && ports_[index]->unread() == 0) return index;
  }
  return ports_.size() < kMostPorts && add_port() ? ports_.size() - 1 : offered_;
}

/// A link that belongs to another process by now stays, and so does ours if there is no other port: then it is shared.
void Pty::offer_another() {
  const std::size_t next = free_port();
  std::error_code error;
  if (next == offered_ || !leads_to_us(link_)) return;
  make_ready(*ports_[next]);
  const std::string other = fmt::format("{}.{}", link_, getpid());
  if (symlink(marked(ports_[next]->path_).c_str(), other.c_str()) != 0) return;
  if (std::rename(other.c_str(), link_.c_str()) != 0) {
    fs::remove(other, error);
    return;
  }
  offered_ = next;
  taken_ = false;
}

}  // namespace s7200::tools
