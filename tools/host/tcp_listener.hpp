// A TCP port of this computer that serves one client after the other, by the rules of server_rules.hpp.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "tools/host/listen_address.hpp"

namespace s7200::tools {

class TcpListener {
 public:
  /// Listens at an address. Returns null and sets `why` if that fails, or the address is not one of this computer alone.
  static std::unique_ptr<TcpListener> open(const ListenAddress& address, std::string& why);
  ~TcpListener();
  TcpListener(const TcpListener&) = delete;
  TcpListener& operator=(const TcpListener&) = delete;

  /// The address with the actual port.
  const ListenAddress& address() const { return address_; }

  /// The descriptor of the port, which stays this one's.
  int descriptor() const { return fd_; }

  /// The descriptor of the next client, to be closed by the caller. -1 after an interruption, or for `why`.
  int accept(std::string& why);

 private:
  TcpListener(int fd, ListenAddress address) : fd_(fd), address_(std::move(address)) {}

  int fd_;
  ListenAddress address_;
};

/// Sends all bytes to a client that accept() returned. 0 or the error: EAGAIN for one that has not read for kMostSilence.
int send_all(int client, std::string_view bytes);

}  // namespace s7200::tools
