#include "tools/slave/host_link.hpp"

#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <future>
#include <thread>
#include <utility>

#include "tools/slave/slave.hpp"
#include "tools/views/machine_text.hpp"

namespace s7200::tools {
namespace {

constexpr Time kPatience = 5 * kSecond;      // with a side that does not take what is sent, or does not let us in
constexpr Time kSlice = 100 * kMillisecond;  // a stop is heard in between

std::string error_text(int error) { return std::strerror(error); }

using Addresses = std::shared_ptr<addrinfo>;

/// The addresses of a host. Null with `why` set if there are none, and after a stop. Name servers may let getaddrinfo(3)
/// wait for long, and nothing calls it off: it has a thread of its own, which is then left to itself.
Addresses look_up(const std::string& host, const std::string& port, StopToken stop, std::string& why) {
  struct Answer {
    int error = 0;
    Addresses addresses;
  };
  std::promise<Answer> promise;
  std::future<Answer> answer = promise.get_future();
  std::thread([host, port, promise = std::move(promise)]() mutable {
    addrinfo wanted{};
    wanted.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    const int error = getaddrinfo(host.c_str(), port.c_str(), &wanted, &found);
    promise.set_value({error, error == 0 ? Addresses(found, freeaddrinfo) : nullptr});
  }).detach();
  while (answer.wait_for(std::chrono::nanoseconds(kSlice)) != std::future_status::ready)
    if (stop.stop_requested()) return nullptr;
  const Answer got = answer.get();
  if (got.error != 0) why = gai_strerror(got.error);
  return got.addresses;
}

}  // namespace

bool HostLink::wait_for(int fd, short events, Time until) const {
  while (!stop_requested()) {
    const Time left = std::clamp(until - host_time(), Time{0}, kSlice);
    const timespec timeout{0, static_cast<long>(left)};
    pollfd waiting{fd, events, 0};
    if (ppoll(&waiting, 1, &timeout, nullptr) > 0) return true;
    if (left == 0) return false;
  }
  return false;
}

void HostLink::sleep_until(Time until) const { wait_for(-1, 0, until); }

bool HostLink::wait_for_input(Time until) const { return wait_for(fd(), POLLIN, until); }

void HostLink::write(std::span<const std::uint8_t> bytes) {
  Time give_up = host_time() + kPatience;
  while (!bytes.empty() && !stop_requested()) {
    const std::size_t taken = write_some(bytes);
    bytes = bytes.subspan(taken);
    if (taken > 0) give_up = host_time() + kPatience;
    if (!bytes.empty() && !wait_for(fd(), POLLOUT, give_up) && !stop_requested()) {
      const std::string who = name();
      close();
      throw SlaveLost(fmt::format("{} takes nothing for {}", who, format_duration(kPatience)));
    }
  }
}

SerialLink::SerialLink(std::string path, const SerialFormat& format, StopToken stop)
    : HostLink(stop), path_(std::move(path)), format_(format) {}

void SerialLink::open() {
  close();
  std::string why;
  auto device = SerialDevice::open(path_, format_, why);
  if (!device) throw SlaveUnreachable(fmt::format("cannot open {}: {}", path_, why));
  device_ = std::make_unique<SerialDevice>(std::move(*device));
}

std::string SerialLink::name() const { return fmt::format("{} {} {}", path_, format_.baud, character_text(format_)); }

void SerialLink::gone(const std::string& why) {
  close();
  throw SlaveLost(fmt::format("{} is gone: {}", path_, why));
}

void SerialLink::read(std::vector<Character>& characters) {
  std::string why;
  if (!device_->read(characters, why)) gone(why);
}

bool SerialLink::drive_sync(bool high) {
  int lines = TIOCM_DTR;
  return ioctl(device_->fd(), high ? TIOCMBIS : TIOCMBIC, &lines) == 0;
}

void SerialLink::drain() { tcdrain(device_->fd()); }

std::size_t SerialLink::write_some(std::span<const std::uint8_t> bytes) {
  std::string why;
  const auto taken = device_->write(bytes, why);
  if (!taken) gone(why);
  return *taken;
}

TcpLink::TcpLink(std::string host, std::string port, StopToken stop)
    : HostLink(stop), host_(std::move(host)), port_(std::move(port)) {}

std::string TcpLink::name() const {
  return host_.find(':') == std::string::npos ? fmt::format("{}:{}", host_, port_) : fmt::format("[{}]:{}", host_, port_);
}

void TcpLink::close() {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
}

void TcpLink::open() {
  close();
  std::string why;
  const Addresses addresses = look_up(host_, port_, stop_, why);
  if (!why.empty()) throw SlaveUnreachable(fmt::format("cannot reach {}: {}", name(), why));

  int error = 0;
  for (const addrinfo* address = addresses.get(); address != nullptr && fd_ < 0 && !stop_requested();
       address = address->ai_next) {
    fd_ = socket(address->ai_family, address->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, address->ai_protocol);
    if (fd_ < 0) {
      error = errno;
      continue;
    }
    error = connect(fd_, address->ai_addr, address->ai_addrlen) == 0 ? 0 : errno;
    if (error == EINPROGRESS) {
      error = ETIMEDOUT;
      socklen_t size = sizeof error;
      if (wait_for(fd_, POLLOUT, host_time() + kPatience)) getsockopt(fd_, SOL_SOCKET, SO_ERROR, &error, &size);
    }
    if (error != 0) close();
  }
  if (fd_ < 0)
    throw SlaveUnreachable(stop_requested() ? fmt::format("{} was not reached before the interruption", name())
                                            : fmt::format("cannot reach {}: {}", name(), error_text(error)));
  const int at_once = 1;
  setsockopt(fd_, IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof at_once);
}

void TcpLink::gone(const std::string& why) {
  close();
  throw SlaveLost(fmt::format("{} {}", name(), why));
}

void TcpLink::read(std::vector<Character>& characters) {
  std::array<std::uint8_t, 4096> bytes{};
  const ssize_t count = recv(fd_, bytes.data(), bytes.size(), 0);
  if (count == 0) gone("has closed the connection");
  if (count < 0 && errno != EAGAIN && errno != EINTR) gone("has broken the connection: " + error_text(errno));
  for (ssize_t i = 0; i < count; ++i) characters.push_back({bytes[static_cast<std::size_t>(i)], false});
}

std::size_t TcpLink::write_some(std::span<const std::uint8_t> bytes) {
  const ssize_t count = send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  if (count >= 0) return static_cast<std::size_t>(count);
  if (errno != EAGAIN && errno != EINTR) gone("has broken the connection: " + error_text(errno));
  return 0;
}

}  // namespace s7200::tools
