#include "tools/host/tcp_listener.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "tools/host/interruption.hpp"
#include "tools/host/server_rules.hpp"

namespace s7200::tools {
namespace {

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

std::unique_ptr<TcpListener> TcpListener::open(const ListenAddress& address, std::string& why) {
  SocketAddress where = socket_address(address);
  if (!is_loopback(where)) {
    why = "only this computer itself is served: 127.0.0.1 or [::1]";
    return nullptr;
  }
  const int fd = socket(where.storage.ss_family, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int on = 1;
  if (fd < 0 || setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) != 0 || bind(fd, where.get(), where.size) != 0 ||
      listen(fd, kMostWaitingClients) != 0) {
    why = std::strerror(errno);
    if (fd >= 0) close(fd);
    return nullptr;
  }
  ListenAddress bound = address;
  bound.port = port_of(fd);
  return std::unique_ptr<TcpListener>(new TcpListener(fd, bound));
}

TcpListener::~TcpListener() { close(fd_); }

int TcpListener::accept(std::string& why) {
  while (!interrupted()) {
    const int client = accept4(fd_, nullptr, nullptr, SOCK_CLOEXEC);
    if (client >= 0) {
      const int on = 1;
      setsockopt(client, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
      setsockopt(client, SOL_SOCKET, SO_KEEPALIVE, &on, sizeof on);
      const timeval unread{.tv_sec = kMostSilence.count(), .tv_usec = 0};
      setsockopt(client, SOL_SOCKET, SO_SNDTIMEO, &unread, sizeof unread);
      return client;
    }
    if (errno == EINTR || errno == ECONNABORTED) continue;
    why = std::strerror(errno);
    return -1;
  }
  return -1;
}

int send_all(int client, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = send(client, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR && !interrupted()) continue;
    if (count < 0) return errno;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return 0;
}

}  // namespace s7200::tools
