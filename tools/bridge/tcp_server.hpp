// TCP clients of a bridge. None of them can block another, fill the memory, or keep a place that it does not use: the rules
// of tools/host/net/server_rules.hpp, as far as the protocols of a line have room for them.
//
// - A client whose first bytes are a request of HTTP has to go before any of them is looked at: a web page has sent it.
// - kMostClients at a time. For one more, the client that has been silent longest has to go.
// - A client that does not read has to go when kMostUnread bytes wait for it.
// - A client that has begun a message has to go when nothing more of it comes for kMostPartial.
// - One whose computer has vanished is found by TCP itself (keep-alive), within about a minute.
// - A client that sends faster than the line takes is not read from meanwhile: TCP holds it back.
// - Of one that has left meanwhile, what it sent and is not on the line is dropped, and how much that was is said. Its
//   system would go on with it and show the end only after it, so programs of this computer that have left are looked for.
// - One that has said its last word, or what makes no sense, is kept until it has its answers. It has to go when kLinger
//   passes in which no answer goes to it, nor the rest of what it sent, once all is read, to the line. One on another
//   computer that has left looks the same.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "interpreter/base/listen_address.hpp"
#include "interpreter/base/result.hpp"
#include "tools/bridge/bridge.hpp"
#include "tools/host/net/server_rules.hpp"

namespace boost::asio {
class io_context;
}

namespace s7200::tools {

class TcpServer {
 public:
  using Client = std::uint64_t;

  static constexpr std::size_t kMostClients = 64;
  static constexpr std::size_t kMostUnread = 65'536;
  static constexpr int kReceiveBuffer = 16'384;  // bytes that the system takes from a client ahead of us
  static constexpr int kMostPartial = static_cast<int>(kMostSilence.count()), kLinger = 10;  // seconds of the computer

  /// The protocol of the server, as the server sees it.
  class Protocol {
   public:
    virtual ~Protocol() = default;

    virtual void came(Client) {}

    virtual void take(Client client, std::span<const std::uint8_t> bytes) = 0;

    /// The client has gone; how many of the bytes for it were not sent.
    virtual std::size_t gone(Client client) = 0;

    /// Why nothing more can come of what a client says; empty as long as something can.
    virtual std::string error(Client) const { return {}; }

    virtual bool wants_more(Client client) const = 0;  ///< may be read from now
    virtual bool expects_answer(Client client) const = 0;
    virtual bool unsent(Client client) const = 0;   ///< something of it is still to go out on the line
    virtual bool partial(Client client) const = 0;  ///< has sent a part of a message, and the rest is up to it
  };

  struct Counts {
    std::uint64_t clients = 0, refused = 0, bytes_in = 0, bytes_out = 0;
    std::uint64_t dropped = 0;  ///< bytes that clients left, whether they had been read or not
  };

  /// Listens, and says where. Trouble if it cannot. The references outlive it.
  static Result<std::unique_ptr<TcpServer>> open(const ListenAddress& address, Protocol& protocol,
                                                 boost::asio::io_context& context, const LiveMessages& messages);

  virtual ~TcpServer() = default;
  virtual void send(Client client, std::span<const std::uint8_t> bytes) = 0;
  virtual void send_to_all(std::span<const std::uint8_t> bytes) = 0;

  /// Reads from connections that had to wait, and looks for those that have to go; to be called often.
  virtual void turn() = 0;
  virtual const Counts& counts() const = 0;
};

}  // namespace s7200::tools
