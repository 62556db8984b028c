// A TCP port of this computer that serves one client after the other, by the rules of server_rules.hpp.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "interpreter/base/listen_address.hpp"
#include "interpreter/base/result.hpp"
#include "tools/host/files/input_stream.hpp"
#include "tools/host/net/sockets.hpp"

namespace s7200::tools {

/// The connection of a client, until its end.
class TcpClient final : public InputStream {
 public:
  explicit TcpClient(NativeSocket socket) : socket_(socket) {}
  ~TcpClient() override;
  TcpClient(const TcpClient&) = delete;
  TcpClient& operator=(const TcpClient&) = delete;

  Reading read(std::span<char> into, std::chrono::milliseconds at_most) override;

  /// Sends all bytes. False if that fails, or the client has not read for kMostSilence.
  bool send(std::string_view bytes);

 private:
  NativeSocket socket_;
};

class TcpListener {
 public:
  /// Listens at an address. Trouble if that fails, or the address is not one of this computer alone.
  static Result<std::unique_ptr<TcpListener>> open(const ListenAddress& address);
  ~TcpListener();
  TcpListener(const TcpListener&) = delete;
  TcpListener& operator=(const TcpListener&) = delete;

  /// The address with the actual port.
  const ListenAddress& address() const { return address_; }

  /// Gives the port away to one that will close it; accept() is not called any more.
  NativeSocket release() { return std::exchange(socket_, kNoSocket); }

  /// The next client. Trouble with nothing to say after an interruption.
  Result<std::unique_ptr<TcpClient>> accept();

 private:
  TcpListener(NativeSocket socket, ListenAddress address) : socket_(socket), address_(std::move(address)) {}

  static constexpr std::string_view kOnlyThisComputer = "only this computer itself is served: 127.0.0.1 or [::1]";

  NativeSocket socket_;
  ListenAddress address_;
};

}  // namespace s7200::tools
