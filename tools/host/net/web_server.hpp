// A web server of this computer alone: a few files that are in memory, and a WebSocket, by the rules of server_rules.hpp.
//
// - All that it has is under /TOKEN/; anything else is not found, whoever asks.
// - Host must be the address that it listens at, or `localhost` with its port: a name that leads here from elsewhere does
//   not do. An Origin that is given must be the same: no other page can open the WebSocket, nor read a file.
// - A request has kMostSilence to come and to be answered; it is GET or HEAD, and has no body.
// - A message has at most kMostMessage bytes and is text. A client that does not answer a ping within twice kMostSilence, or
//   lets more than kMostUnread bytes wait, has to go; nobody waits for it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "tools/host/net/server_rules.hpp"
#include "tools/host/net/tcp_listener.hpp"

namespace s7200::tools {

struct WebFile {
  std::string_view name;  ///< "" for the address itself
  std::string_view type;  ///< `text/html; charset=utf-8`
  std::string_view bytes;
};

class WebServer {
 public:
  using Client = std::uint64_t;  ///< a number that no other client gets

  static constexpr std::size_t kMostConnections = 64;
  static constexpr std::size_t kMostMessage = 1 << 20;
  static constexpr std::size_t kMostUnread = 32 << 20;
  static constexpr std::string_view kSocket = "socket";  ///< the name of the WebSocket

  /// All are called in the server's thread, and must not wait.
  struct Calls {
    std::function<void(Client)> joined;
    /// Returns why the client has to go; empty if it may stay.
    std::function<std::string(Client, std::string message)> came;
    std::function<void(Client)> left;
    std::function<void(const std::string& note)> said;  ///< a client that was turned away, and why
    std::function<void()> now_and_then;                 ///< every 100 ms
  };

  /// Serves in a thread of its own until it is destroyed. The files live as long as this.
  WebServer(std::unique_ptr<TcpListener> listener, std::string token, std::vector<WebFile> files, Calls calls);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  /// The address of the page: `http://127.0.0.1:4712/5b8c…/`
  std::string address() const;

  // From any thread. What is sent to a client that has gone is dropped.
  void send(Client client, std::string message);
  void send_to_all(std::string message);

 private:
  class Served;
  std::shared_ptr<Served> served_;
};

}  // namespace s7200::tools
