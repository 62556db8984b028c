#include "tools/host/net/sockets.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <future>
#include <sstream>
#include <thread>
#include <utility>

#include "interpreter/base/result.hpp"
#include "tools/host/interruption.hpp"
#include "tools/host/net/server_rules.hpp"
#include "tools/host/net/tcp_listener.hpp"
#include "tools/host/posix/descriptor_stream.hpp"

namespace s7200::tools {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kSlice{100};  // a stop is heard in between

int descriptor_of(NativeSocket socket) { return static_cast<int>(socket); }

struct SocketAddress {
  sockaddr_storage storage{};
  socklen_t size = 0;

  sockaddr* get() { return reinterpret_cast<sockaddr*>(&storage); }
};

SocketAddress socket_address(const ListenAddress& address) {
  SocketAddress result;
  if (address.host.find(':') != std::string::npos) {
    auto* const six = reinterpret_cast<sockaddr_in6*>(&result.storage);
    six->sin6_family = AF_INET6;
    six->sin6_port = htons(address.port);
    inet_pton(AF_INET6, address.host.c_str(), &six->sin6_addr);
    result.size = sizeof(sockaddr_in6);
  } else {
    auto* const four = reinterpret_cast<sockaddr_in*>(&result.storage);
    four->sin_family = AF_INET;
    four->sin_port = htons(address.port);
    inet_pton(AF_INET, address.host.c_str(), &four->sin_addr);
    result.size = sizeof(sockaddr_in);
  }
  return result;
}

bool is_loopback(SocketAddress address) {
  if (address.storage.ss_family == AF_INET6)
    return IN6_IS_ADDR_LOOPBACK(&reinterpret_cast<sockaddr_in6*>(&address.storage)->sin6_addr);
  return ntohl(reinterpret_cast<sockaddr_in*>(&address.storage)->sin_addr.s_addr) >> 24 == 127;
}

std::uint16_t port_of(int fd) {
  SocketAddress bound;
  bound.size = sizeof bound.storage;
  getsockname(fd, bound.get(), &bound.size);
  return ntohs(bound.storage.ss_family == AF_INET6 ? reinterpret_cast<sockaddr_in6*>(&bound.storage)->sin6_port
                                                   : reinterpret_cast<sockaddr_in*>(&bound.storage)->sin_port);
}

}  // namespace

std::string socket_error_text(int error) { return std::strerror(error); }

bool allow_next_listener(NativeSocket socket) {
  const int on = 1;
  return setsockopt(descriptor_of(socket), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) == 0;
}

// --- clients of a bridge ---

void keep_alive(NativeSocket socket) {
  const auto set = [&](int option, int value) {
    setsockopt(descriptor_of(socket), IPPROTO_TCP, option, &value, sizeof value);
  };
  set(TCP_KEEPIDLE, 30);
  set(TCP_KEEPINTVL, 10);
  set(TCP_KEEPCNT, 3);
  set(TCP_USER_TIMEOUT, 60'000);
}

Peer look_at_peer(NativeSocket socket) {
  pollfd state{descriptor_of(socket), POLLRDHUP, 0};
  ::poll(&state, 1, 0);
  if ((state.revents & (POLLERR | POLLHUP)) != 0) return Peer::Gone;
  return (state.revents & POLLRDHUP) != 0 ? Peer::SaidLastWord : Peer::Open;
}

namespace {

/// An end of a connection as /proc/net/tcp writes it: words of 32 bits in the order of this computer.
struct ProcEnd {
  std::string text;
  bool four = false;
};

ProcEnd end_of(SocketAddress address) {
  std::span<const std::uint8_t> bytes;
  std::uint16_t port = 0;
  if (address.storage.ss_family == AF_INET6) {
    const auto* const six = reinterpret_cast<const sockaddr_in6*>(&address.storage);
    bytes = six->sin6_addr.s6_addr;
    if (IN6_IS_ADDR_V4MAPPED(&six->sin6_addr)) bytes = bytes.last(4);
    port = ntohs(six->sin6_port);
  } else {
    const auto* const four = reinterpret_cast<const sockaddr_in*>(&address.storage);
    bytes = std::span(reinterpret_cast<const std::uint8_t*>(&four->sin_addr), 4);
    port = ntohs(four->sin_port);
  }
  ProcEnd end{.text = {}, .four = bytes.size() == 4};
  for (std::size_t i = 0; i < bytes.size(); i += 4)
    end.text +=
        fmt::format("{:08X}", std::bit_cast<std::uint32_t>(std::array{bytes[i], bytes[i + 1], bytes[i + 2], bytes[i + 3]}));
  end.text += fmt::format(":{:04X}", port);
  return end;
}

}  // namespace

/// An end that no program has open any more has no inode (proc(5), /proc/net/tcp).
std::optional<std::size_t> left_behind(NativeSocket socket) {
  SocketAddress its, ours;
  its.size = ours.size = sizeof its.storage;
  const int fd = descriptor_of(socket);
  if (getpeername(fd, its.get(), &its.size) != 0 || getsockname(fd, ours.get(), &ours.size) != 0) return {};
  const ProcEnd from = end_of(its);
  const std::string ends = from.text + ' ' + end_of(ours).text;
  std::ifstream table(from.four ? "/proc/net/tcp" : "/proc/net/tcp6");
  for (std::string line; std::getline(table, line);) {
    const std::size_t place = line.find(ends);
    if (place == std::string::npos) continue;
    std::istringstream rest(line.substr(place + ends.size()));
    std::string state, queues, timer, retries, user, timeout;
    std::uint64_t inode = 1;
    rest >> state >> queues >> timer >> retries >> user >> timeout >> inode;
    if (inode != 0) return {};
    return std::stoul(queues, nullptr, 16);
  }
  return {};
}

// --- a listener, and its clients ---

Result<std::unique_ptr<TcpListener>> TcpListener::open(const ListenAddress& address) {
  SocketAddress where = socket_address(address);
  if (!is_loopback(where)) return Trouble{std::string(kOnlyThisComputer)};
  const int fd = socket(where.storage.ss_family, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (fd < 0 || !allow_next_listener(fd) || bind(fd, where.get(), where.size) != 0 || listen(fd, kMostWaitingClients) != 0) {
    Trouble refused{std::strerror(errno)};
    if (fd >= 0) close(fd);
    return refused;
  }
  ListenAddress bound = address;
  bound.port = port_of(fd);
  return std::unique_ptr<TcpListener>(new TcpListener(fd, bound));
}

TcpListener::~TcpListener() {
  if (socket_ != kNoSocket) close(descriptor_of(socket_));
}

Result<std::unique_ptr<TcpClient>> TcpListener::accept() {
  while (!interrupted()) {
    const int client = accept4(descriptor_of(socket_), nullptr, nullptr, SOCK_CLOEXEC);
    if (client >= 0) {
      const int on = 1;
      setsockopt(client, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
      setsockopt(client, SOL_SOCKET, SO_KEEPALIVE, &on, sizeof on);
      const timeval unread{.tv_sec = kMostSilence.count(), .tv_usec = 0};
      setsockopt(client, SOL_SOCKET, SO_SNDTIMEO, &unread, sizeof unread);
      return std::make_unique<TcpClient>(client);
    }
    if (errno == EINTR || errno == ECONNABORTED) continue;
    return Trouble{std::strerror(errno)};
  }
  return std::nullopt;
}

TcpClient::~TcpClient() { close(descriptor_of(socket_)); }

InputStream::Reading TcpClient::read(std::span<char> into, std::chrono::milliseconds at_most) {
  return read_descriptor(descriptor_of(socket_), into, at_most);
}

bool TcpClient::send(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::send(descriptor_of(socket_), bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR && !interrupted()) continue;
    if (count < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

// --- a connection to a server ---

namespace {

using Addresses = std::shared_ptr<addrinfo>;

/// The addresses of a host. Trouble if there are none, with nothing to say after a stop. Name servers may let getaddrinfo(3)
/// wait for long, and nothing calls it off: it has a thread of its own, which is then left to itself.
Result<Addresses> look_up(const std::string& host, const std::string& port, StopToken stop) {
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
  while (answer.wait_for(kSlice) != std::future_status::ready)
    if (stop.stop_requested()) return std::nullopt;
  const Answer got = answer.get();
  if (got.error != 0) return Trouble{gai_strerror(got.error)};
  return got.addresses;
}

bool wait_for(NativeSocket socket, short events, std::chrono::nanoseconds at_most) {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(at_most);
  const timespec timeout{seconds.count(), static_cast<long>((at_most - seconds).count())};
  pollfd waiting{descriptor_of(socket), events, 0};
  return ppoll(&waiting, 1, &timeout, nullptr) > 0;
}

/// 0 or the error of connecting.
int connect_to(int fd, const addrinfo& address, std::chrono::nanoseconds patience, StopToken stop) {
  if (connect(fd, address.ai_addr, address.ai_addrlen) == 0) return 0;
  if (errno != EINPROGRESS) return errno;
  int error = ETIMEDOUT;
  socklen_t size = sizeof error;
  for (const auto give_up = Clock::now() + patience; Clock::now() < give_up && !stop.stop_requested();)
    if (wait_for(fd, POLLOUT, kSlice)) return getsockopt(fd, SOL_SOCKET, SO_ERROR, &error, &size), error;
  return error;
}

}  // namespace

Result<std::unique_ptr<TcpConnection>> TcpConnection::open(const std::string& host, const std::string& port,
                                                           std::chrono::nanoseconds patience, StopToken stop) {
  const auto addresses = look_up(host, port, stop);
  if (!addresses) return addresses.trouble();
  int error = 0;
  for (const addrinfo* address = addresses->get(); address != nullptr && !stop.stop_requested();
       address = address->ai_next) {
    const int fd = socket(address->ai_family, address->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, address->ai_protocol);
    error = fd < 0 ? errno : connect_to(fd, *address, patience, stop);
    if (fd < 0) continue;
    if (error == 0) {
      const int at_once = 1;
      setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof at_once);
      return std::unique_ptr<TcpConnection>(new TcpConnection(fd));
    }
    close(fd);
  }
  if (stop.stop_requested()) return std::nullopt;
  return Trouble{std::strerror(error)};
}

TcpConnection::~TcpConnection() { close(descriptor_of(socket_)); }

bool TcpConnection::wait_for_input(std::chrono::nanoseconds at_most) const { return wait_for(socket_, POLLIN, at_most); }

bool TcpConnection::wait_for_room(std::chrono::nanoseconds at_most) const { return wait_for(socket_, POLLOUT, at_most); }

Result<std::size_t> TcpConnection::read(std::span<std::uint8_t> into) {
  const ssize_t count = recv(descriptor_of(socket_), into.data(), into.size(), 0);
  if (count > 0) return static_cast<std::size_t>(count);
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return 0;
  return Trouble{count == 0 ? "has closed the connection"
                            : std::string("has broken the connection: ") + std::strerror(errno)};
}

Result<std::size_t> TcpConnection::write(std::span<const std::uint8_t> bytes) {
  const ssize_t count = ::send(descriptor_of(socket_), bytes.data(), bytes.size(), MSG_NOSIGNAL);
  if (count >= 0) return static_cast<std::size_t>(count);
  if (errno == EAGAIN || errno == EINTR) return 0;
  return Trouble{std::string("has broken the connection: ") + std::strerror(errno)};
}

}  // namespace s7200::tools
