#include "tools/host/net/sockets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <future>
#include <thread>
#include <utility>

#include "interpreter/base/result.hpp"
#include "tools/host/interruption.hpp"
#include "tools/host/net/server_rules.hpp"
#include "tools/host/net/tcp_listener.hpp"
#include "tools/host/windows/native_text.hpp"

// After winsock2.h.
#include <ws2tcpip.h>

namespace s7200::tools {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kSlice{100};  // a stop is heard in between

/// The sockets of Windows have to be started; it counts how often.
void start_sockets() {
  static const int kStarted = [] {
    WSADATA data{};
    return WSAStartup(MAKEWORD(2, 2), &data);
  }();
  static_cast<void>(kStarted);
}

SOCKET socket_of(NativeSocket socket) { return static_cast<SOCKET>(socket); }
NativeSocket native(SOCKET socket) { return static_cast<NativeSocket>(socket); }

struct SocketAddress {
  sockaddr_storage storage{};
  int size = 0;

  sockaddr* get() { return reinterpret_cast<sockaddr*>(&storage); }
  std::uint16_t port() const {  // it stands at the same place for both versions
    return ntohs(reinterpret_cast<const sockaddr_in*>(&storage)->sin_port);
  }
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

bool is_loopback(const SocketAddress& address) {
  if (address.storage.ss_family == AF_INET6) {
    const auto& bytes = reinterpret_cast<const sockaddr_in6*>(&address.storage)->sin6_addr.s6_addr;
    return bytes[15] == 1 && std::all_of(bytes, bytes + 15, [](unsigned char byte) { return byte == 0; });
  }
  return ntohl(reinterpret_cast<const sockaddr_in*>(&address.storage)->sin_addr.s_addr) >> 24 == 127;
}

bool set_option(SOCKET socket, int level, int option, int value) {
  return setsockopt(socket, level, option, reinterpret_cast<const char*>(&value), sizeof value) == 0;
}

/// Whether one of the events comes within that time; errors and the end count.
bool wait_for(NativeSocket socket, short events, std::chrono::nanoseconds at_most) {
  WSAPOLLFD waiting{socket_of(socket), events, 0};
  return WSAPoll(&waiting, 1, static_cast<int>(std::chrono::ceil<std::chrono::milliseconds>(at_most).count())) > 0;
}

void never_wait(SOCKET socket) {
  u_long on = 1;
  ioctlsocket(socket, static_cast<long>(FIONBIO), &on);
}

}  // namespace

std::string socket_error_text(int error) { return words_of(static_cast<DWORD>(error)); }

/// A port is free at once in Windows; SO_REUSEADDR would let two programs have it at the same time.
bool allow_next_listener(NativeSocket socket) { return set_option(socket_of(socket), SOL_SOCKET, SO_EXCLUSIVEADDRUSE, 1); }

void keep_alive(NativeSocket socket) {
  constexpr int kIdle = 3, kRetries = 16, kInterval = 17;  // TCP_KEEPIDLE, TCP_KEEPCNT, TCP_KEEPINTVL of ws2ipdef.h
  set_option(socket_of(socket), IPPROTO_TCP, kIdle, 30);
  set_option(socket_of(socket), IPPROTO_TCP, kInterval, 10);
  set_option(socket_of(socket), IPPROTO_TCP, kRetries, 3);
}

Peer look_at_peer(NativeSocket socket) {
  WSAPOLLFD state{socket_of(socket), POLLRDNORM, 0};
  if (WSAPoll(&state, 1, 0) <= 0) return Peer::Open;
  if ((state.revents & POLLERR) != 0) return Peer::Gone;
  return (state.revents & POLLHUP) != 0 ? Peer::SaidLastWord : Peer::Open;
}

std::optional<std::size_t> left_behind(NativeSocket) { return {}; }

// --- a listener, and its clients ---

Result<std::unique_ptr<TcpListener>> TcpListener::open(const ListenAddress& address) {
  start_sockets();
  SocketAddress where = socket_address(address);
  if (!is_loopback(where)) return Trouble{std::string(kOnlyThisComputer)};
  const SOCKET listening = WSASocketW(where.storage.ss_family, SOCK_STREAM, IPPROTO_TCP, nullptr, 0,
                                      WSA_FLAG_OVERLAPPED | WSA_FLAG_NO_HANDLE_INHERIT);
  SocketAddress bound;
  bound.size = sizeof bound.storage;
  if (listening == INVALID_SOCKET || !allow_next_listener(native(listening)) ||
      bind(listening, where.get(), where.size) != 0 || listen(listening, kMostWaitingClients) != 0 ||
      getsockname(listening, bound.get(), &bound.size) != 0) {
    Trouble refused{socket_error_text(WSAGetLastError())};
    if (listening != INVALID_SOCKET) closesocket(listening);
    return refused;
  }
  return std::unique_ptr<TcpListener>(new TcpListener(native(listening), {.host = address.host, .port = bound.port()}));
}

TcpListener::~TcpListener() {
  if (socket_ != kNoSocket) closesocket(socket_of(socket_));
}

Result<std::unique_ptr<TcpClient>> TcpListener::accept() {
  while (!interrupted()) {
    if (!wait_for(socket_, POLLRDNORM, kSlice)) continue;
    const SOCKET client = ::accept(socket_of(socket_), nullptr, nullptr);
    if (client != INVALID_SOCKET) {
      set_option(client, IPPROTO_TCP, TCP_NODELAY, 1);
      set_option(client, SOL_SOCKET, SO_KEEPALIVE, 1);
      set_option(client, SOL_SOCKET, SO_SNDTIMEO, static_cast<int>(std::chrono::milliseconds(kMostSilence).count()));
      return std::make_unique<TcpClient>(native(client));
    }
    if (WSAGetLastError() == WSAECONNRESET) continue;
    return Trouble{socket_error_text(WSAGetLastError())};
  }
  return std::nullopt;
}

TcpClient::~TcpClient() { closesocket(socket_of(socket_)); }

InputStream::Reading TcpClient::read(std::span<char> into, std::chrono::milliseconds at_most) {
  if (!wait_for(socket_, POLLRDNORM, at_most)) return {};
  const int count = recv(socket_of(socket_), into.data(), static_cast<int>(into.size()), 0);
  if (count > 0) return {.came = Came::Bytes, .count = static_cast<std::size_t>(count)};
  if (count == 0) return {.came = Came::End};
  return {.came = Came::Failure, .why = socket_error_text(WSAGetLastError())};
}

bool TcpClient::send(std::string_view bytes) {
  while (!bytes.empty()) {
    const int count =
        ::send(socket_of(socket_), bytes.data(), static_cast<int>(std::min<std::size_t>(bytes.size(), 1 << 20)), 0);
    if (count < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

// --- a connection to a server ---

namespace {

using Addresses = std::shared_ptr<ADDRINFOW>;

/// The addresses of a host. Trouble if there are none, with nothing to say after a stop. Name servers may let the system
/// wait for long, and nothing calls it off: it has a thread of its own, which is then left to itself.
Result<Addresses> look_up(const std::string& host, const std::string& port, StopToken stop) {
  struct Answer {
    int error = 0;
    Addresses addresses;
  };
  std::promise<Answer> promise;
  std::future<Answer> answer = promise.get_future();
  std::thread([host = wide(host), port = wide(port), promise = std::move(promise)]() mutable {
    ADDRINFOW wanted{};
    wanted.ai_socktype = SOCK_STREAM;
    ADDRINFOW* found = nullptr;
    const int error = GetAddrInfoW(host.c_str(), port.c_str(), &wanted, &found);
    promise.set_value({error, error == 0 ? Addresses(found, FreeAddrInfoW) : nullptr});
  }).detach();
  while (answer.wait_for(kSlice) != std::future_status::ready)
    if (stop.stop_requested()) return std::nullopt;
  const Answer got = answer.get();
  if (got.error != 0) return Trouble{socket_error_text(got.error)};
  return got.addresses;
}

/// Waits for a slice. Not by WSAPoll(), which before version 2004 of Windows 10 did not tell that it has failed.
bool has_connected_or_failed(SOCKET socket) {
  fd_set done{1, {socket}}, failed{1, {socket}};
  timeval slice{0, static_cast<long>(std::chrono::microseconds(kSlice).count())};
  return select(0, nullptr, &done, &failed, &slice) > 0;
}

/// 0 or the error of connecting.
int connect_to(SOCKET socket, const ADDRINFOW& address, std::chrono::nanoseconds patience, StopToken stop) {
  if (connect(socket, address.ai_addr, static_cast<int>(address.ai_addrlen)) == 0) return 0;
  if (WSAGetLastError() != WSAEWOULDBLOCK) return WSAGetLastError();
  int error = WSAETIMEDOUT, size = sizeof error;
  for (const auto give_up = Clock::now() + patience; Clock::now() < give_up && !stop.stop_requested();) {
    if (!has_connected_or_failed(socket)) continue;
    getsockopt(socket, SOL_SOCKET, SO_ERROR, reinterpret_cast<char*>(&error), &size);
    return error;
  }
  return error;
}

}  // namespace

Result<std::unique_ptr<TcpConnection>> TcpConnection::open(const std::string& host, const std::string& port,
                                                           std::chrono::nanoseconds patience, StopToken stop) {
  start_sockets();
  const auto addresses = look_up(host, port, stop);
  if (!addresses) return addresses.trouble();
  int error = 0;
  for (const ADDRINFOW* address = addresses->get(); address != nullptr && !stop.stop_requested();
       address = address->ai_next) {
    const SOCKET socket = WSASocketW(address->ai_family, address->ai_socktype, address->ai_protocol, nullptr, 0,
                                     WSA_FLAG_OVERLAPPED | WSA_FLAG_NO_HANDLE_INHERIT);
    if (socket == INVALID_SOCKET) {
      error = WSAGetLastError();
      continue;
    }
    never_wait(socket);
    error = connect_to(socket, *address, patience, stop);
    if (error == 0) {
      set_option(socket, IPPROTO_TCP, TCP_NODELAY, 1);
      return std::unique_ptr<TcpConnection>(new TcpConnection(native(socket)));
    }
    closesocket(socket);
  }
  if (stop.stop_requested()) return std::nullopt;
  return Trouble{socket_error_text(error)};
}

TcpConnection::~TcpConnection() { closesocket(socket_of(socket_)); }

bool TcpConnection::wait_for_input(std::chrono::nanoseconds at_most) const { return wait_for(socket_, POLLRDNORM, at_most); }

bool TcpConnection::wait_for_room(std::chrono::nanoseconds at_most) const { return wait_for(socket_, POLLWRNORM, at_most); }

Result<std::size_t> TcpConnection::read(std::span<std::uint8_t> into) {
  const int count = recv(socket_of(socket_), reinterpret_cast<char*>(into.data()), static_cast<int>(into.size()), 0);
  if (count > 0) return static_cast<std::size_t>(count);
  if (count < 0 && WSAGetLastError() == WSAEWOULDBLOCK) return 0;
  return Trouble{count == 0 ? "has closed the connection"
                            : "has broken the connection: " + socket_error_text(WSAGetLastError())};
}

Result<std::size_t> TcpConnection::write(std::span<const std::uint8_t> bytes) {
  const int count =
      ::send(socket_of(socket_), reinterpret_cast<const char*>(bytes.data()), static_cast<int>(bytes.size()), 0);
  if (count >= 0) return static_cast<std::size_t>(count);
  if (WSAGetLastError() == WSAEWOULDBLOCK) return 0;
  return Trouble{"has broken the connection: " + socket_error_text(WSAGetLastError())};
}

}  // namespace s7200::tools
