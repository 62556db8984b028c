// What the rooms above need of the sockets of the system.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "interpreter/base/result.hpp"
#include "interpreter/base/stop_token.hpp"

namespace s7200::tools {

/// A descriptor; on Windows a SOCKET.
using NativeSocket = std::intptr_t;
inline constexpr NativeSocket kNoSocket = -1;

/// The words for an error of sockets, as Boost.Asio reports its number: on Windows not those of the system, which come in
/// its language, or not at all.
std::string socket_error_text(int error);

/// A port of a listener that has ended is free for the next one at once; one that another program has is not.
/// False if the system does not do it.
bool allow_next_listener(NativeSocket socket);

/// Lets the system find out within about a minute that the computer of a client has vanished.
void keep_alive(NativeSocket socket);

/// A client that is not read from just now.
enum class Peer : std::uint8_t {
  Open,
  SaidLastWord,  ///< it sends nothing more
  Gone
};
Peer look_at_peer(NativeSocket socket);

/// The bytes that a program of this computer left to its system to send when it closed its end of a connection. Nothing if
/// its end is open, or not on this computer, or the system does not tell, as Windows does not.
std::optional<std::size_t> left_behind(NativeSocket socket);

/// A connection to a server. What fails is said as after "cannot reach 127.0.0.1:502: " or "127.0.0.1:502 ".
class TcpConnection {
 public:
  /// Tries each address of a host, by name or number, for as long as `patience`. Trouble if none answers, with nothing
  /// to say after a stop.
  static Result<std::unique_ptr<TcpConnection>> open(const std::string& host, const std::string& port,
                                                     std::chrono::nanoseconds patience, StopToken stop);
  ~TcpConnection();
  TcpConnection(const TcpConnection&) = delete;
  TcpConnection& operator=(const TcpConnection&) = delete;

  /// Whether there is something to read, the end too, or room to write, within that time.
  bool wait_for_input(std::chrono::nanoseconds at_most) const;
  bool wait_for_room(std::chrono::nanoseconds at_most) const;

  /// Never wait. The number of bytes, 0 if there are none, or there is no room, just now; trouble when the connection is
  /// over.
  Result<std::size_t> read(std::span<std::uint8_t> into);
  Result<std::size_t> write(std::span<const std::uint8_t> bytes);

 private:
  explicit TcpConnection(NativeSocket socket) : socket_(socket) {}
  NativeSocket socket_;
};

}  // namespace s7200::tools
