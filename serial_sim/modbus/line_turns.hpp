// Several clients, one line: whose request goes out next, and which answer is whose.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "interpreter/base/serial_port.hpp"
#include "serial_sim/modbus/crc.hpp"

namespace s7200::modbus {

/// Requests go out one after the other; clients take turns. An answer ends with 3.5 characters of silence. All times are
/// simulated.
class LineTurns {
 public:
  using Client = std::uint64_t;

  struct Request {
    Bytes frame;  ///< with CRC; sent as it is
    bool wants_answer = true;
    std::uint64_t tag = 0;  ///< comes back with the outcome
  };

  enum class Result : std::uint8_t {
    Answered,  ///< characters without errors
    Damaged,   ///< one had a parity or framing error, or there were more than an RTU frame has
    Silent,    ///< no answer began in time
    Blocked,   ///< the line was never quiet: the request was not sent
    Sent,      ///< no answer was wanted
  };

  struct Outcome {
    Client client = 0;
    std::uint64_t tag = 0;
    Result result{};
    Bytes answer;  ///< what was heard, damaged or not
  };

  /// The line at an instant.
  struct Line {
    Time now = 0;
    SerialFormat format{};
    bool sending = false;    ///< our own characters are under way
    bool receiving = false;  ///< a character is coming in
    Time quiet_since = 0;    ///< end of the last character, whoever sent it
    Time quiet_time = 0;     ///< to be left between two frames
  };

  /// How long the line is kept for the answer to a request whose client has gone, unless the timeout is shorter. No other
  /// slave is asked until then, because that answer would be taken for its.
  static constexpr Time kLateAnswer = 400 * kMillisecond;

  /// The time that a master leaves all stations to carry out a broadcast (Modbus over Serial Line V1.02, 2.4.1: 100 to 200
  /// ms).
  static constexpr Time kTurnaround = 100 * kMillisecond;

  /// `timeout` is the time to wait for the start of an answer, and for a line that is quiet enough to ask.
  explicit LineTurns(Time timeout) : timeout_(timeout) {}

  void ask(Client client, Request request);

  /// Drops the client's requests; a request on the line ends without an outcome. Returns the tags of all of them.
  std::vector<std::uint64_t> forget(Client client);

  /// Requests of a client that have no outcome yet.
  std::size_t open(Client client) const;

  /// Bytes of a client's requests that wait for the line; and whether there are any, or some are going out just now.
  std::size_t waiting(Client client) const;
  bool unsent(Client client) const { return waiting(client) != 0 || (on_line(client) && phase_ == Phase::Sending); }

  /// The client stops waiting for answers: its requests that want one are dropped, and a request on the line ends without an
  /// outcome. Its other requests stay. Returns how many were given up.
  std::size_t stop_waiting(Client client);

  /// Returns the bytes to put on the line now, mostly none. To be called when anything has happened, and at due().
  Bytes turn(const Line& line);

  /// A character that came after what turn() gave was sent, whether turn() has seen the end of that or not.
  void received(const ReceivedCharacter& character, const SerialFormat& format);
  Time due() const { return due_; }

  std::vector<Outcome> take_outcomes();

 private:
  enum class Phase : std::uint8_t { Idle, Sending, Waiting, Receiving };
  struct Current {
    Client client = 0;
    Request request;
  };

  bool on_line(Client client) const { return phase_ != Phase::Idle && current_.client == client; }
  void look(const Line& line);
  Bytes next_frame(const Line& line);
  void end(Result result);

  Time timeout_;
  std::map<Client, std::deque<Request>> waiting_;  ///< no client without a request
  Client last_served_ = 0;
  Phase phase_ = Phase::Idle;
  Current current_;
  bool current_forgotten_ = false, damaged_ = false, too_long_ = false;
  Bytes answer_;
  Time asked_ = 0;                        ///< end of the request
  Time answer_end_ = 0;                   ///< of its last character
  Time unanswered_until_ = 0;             ///< end of the last wait in vain; slaves may take the line for quiet only after it
  std::optional<Time> wants_line_since_;  ///< a client has
  Time due_ = kNever;
  std::vector<Outcome> outcomes_;
};

}  // namespace s7200::modbus
