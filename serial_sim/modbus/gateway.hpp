// Modbus TCP to a serial line: the protocol part of a gateway, free of sockets.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "serial_sim/modbus/line_turns.hpp"
#include "serial_sim/modbus/mbap.hpp"

namespace s7200::modbus {

/// Each request of a client is answered once:
/// - with the slave's answer, if its CRC, station and function are right
/// - with exception 0B if no such answer came in time
/// - with exception 0A, at once, for units 248 to 255, which no slave may have (Modbus over Serial Line, 2.2), and for a
///   request to unit 0 that needs an answer, such as a read: no slave answers a broadcast
/// Unit 0 is the broadcast of the serial line: no slave answers, nor does the gateway if it has sent one. A client may send
/// further requests before the first is answered; kMostOpen of them are taken, the others wait in its stream.
///
/// On a line with an echo the request itself comes back first, and is taken for the answer: station, function and CRC fit.
class Gateway {
 public:
  using Client = LineTurns::Client;

  static constexpr std::size_t kMostOpen = 16;

  struct Answer {
    Client client = 0;
    Bytes bytes;
  };

  struct Counts {
    std::uint64_t requests = 0, answers = 0, silent = 0, damaged = 0, no_path = 0, broadcasts = 0;
    bool operator==(const Counts&) const = default;
  };

  explicit Gateway(Time timeout) : turns_(timeout) {}

  /// Bytes from a client; a client is known from its first bytes until forget().
  void take(Client client, std::span<const std::uint8_t> bytes);

  /// A client has gone: what it still waits for is dropped.
  void forget(Client client);

  /// Why the rest of a client's stream cannot be read; empty while it can.
  std::string error(Client client) const;

  /// Whether more may be read from a client: it has neither too many requests open nor a backlog of them.
  bool wants_more(Client client) const;

  /// Requests of a client that will still be answered; and whether one has come in part.
  std::size_t open(Client client) const;
  bool partial(Client client) const;

  /// Bytes of a client that wait for the line or for the rest of their message; and whether some are still to go out.
  std::size_t waiting(Client client) const;
  bool unsent(Client client) const { return turns_.unsent(client); }

  Bytes turn(const LineTurns::Line& line);
  void received(const ReceivedCharacter& character, const SerialFormat& format) { turns_.received(character, format); }
  Time due() const { return turns_.due(); }

  std::vector<Answer> take_answers();
  const Counts& counts() const { return counts_; }

 private:
  void take_requests(Client client, MbapReader& stream);
  void settle(const LineTurns::Outcome& outcome);
  void answer(Client client, const TcpMessage& message) { answers_.push_back({client, to_bytes(message)}); }

  LineTurns turns_;
  std::map<Client, MbapReader> streams_;
  std::map<std::uint64_t, TcpMessage> asked_;  ///< by tag
  std::uint64_t next_tag_ = 0;
  std::vector<Answer> answers_;
  Counts counts_;
};

}  // namespace s7200::modbus
