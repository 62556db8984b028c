// A master on the line: sends a request, waits for the answer, tells how it went; and hears what comes unasked.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "interpreter/base/event_queue.hpp"
#include "serial_sim/line/frame.hpp"
#include "serial_sim/line/line_settings.hpp"
#include "serial_sim/line/uart.hpp"

namespace s7200::serial {

struct Request {
  Frame frame;                    ///< at least one character; sent as it is
  Time timeout = kSecond;         ///< from the end of the request to the start edge of the answer
  Time gap = 0;                   ///< between the characters of the request
  std::optional<Time> silence{};  ///< that ends an answer; 3.5 characters of the master's format if not given
  bool sync = false;              ///< the sync signal beside the data is high from its first start bit to its last stop bit

  bool operator==(const Request&) const = default;
};

/// The settings of a master and its habits.
struct MasterSettings : LineSettings {
  Time timeout = kSecond;
  Time gap = 0;

  Request request(const Frame& of) const { return {.frame = of, .timeout = timeout, .gap = gap}; }
};

/// The way to wait for a transmission that was not asked for.
struct Listening {
  Time timeout = kSecond;         ///< from now to its start edge
  std::optional<Time> silence{};  ///< that ends it; 3.5 characters of the master's format if not given
};

Bytes bytes_of(const std::vector<ReceivedCharacter>& characters);

/// A request and the answer to it. After Requester::listen() the request is empty, and its times are when the listening
/// began.
struct Exchange {
  Frame request;
  Time request_start = 0;
  Time request_end = 0;                   ///< end of the last stop bit
  std::vector<ReceivedCharacter> echo{};  ///< what the master heard while it sent; nothing on a line without echo
  std::vector<ReceivedCharacter> response{};
  Time response_start = 0;         ///< start edge of the first character, or 0 if there is none; so is the next
  Time response_end = 0;           ///< end of the last character's stop bit
  bool timed_out = false;          ///< no answer began in time
  bool too_long = false;           ///< cut off after Requester::kLongestResponse characters
  bool given_up = false;           ///< by Requester::give_up(), before its answer was complete
  bool of_another_master = false;  ///< the answer began while another master of the line was sending its request
  bool early = false;  ///< another station held the line at space when the request ended: its start edge was not heard

  bool operator==(const Exchange&) const = default;

  std::optional<Time> latency() const;
  bool parity_error() const;
  bool framing_error() const;
  /// The damage to the answer's characters, whatever they say: `characters with wrong parity`. Empty if the answer is
  /// intact.
  std::string_view damage() const;
  Bytes response_bytes() const { return bytes_of(response); }
};

/// Half duplex: its receiver is off from the start of the request to the end of its last stop bit, unless the line gives an
/// echo. The format is its UART's. What it hears while it asks nothing is kept for listen().
/// To whoever handles the events: reports of the UART go to on(), the events of its own number to handle().
class Requester {
 public:
  static constexpr std::size_t kLongestResponse = kLongestRawFrame;
  static constexpr std::size_t kMostHeard = 4096;  ///< what comes when so many wait is lost, as in a computer's serial port

  enum class Phase : std::uint8_t { Idle, Sending, Waiting, Receiving };

  /// Plain, so that a snapshot is a copy.
  struct State {
    Phase phase = Phase::Idle;
    Request request;
    std::size_t sent = 0;  ///< characters of the request
    Exchange exchange;
    std::vector<ReceivedCharacter> heard{};  ///< unasked, since the last request began; not yet listened to
    bool operator==(const State&) const = default;
  };

  /// `owner` is the requester's number in the queue, for its own timers. Neither reference is owned.
  Requester(Uart& uart, EventQueue& queue, EventOwner owner);

  /// The first start bit begins at `at`. The last exchange is over. What was heard before and not listened to is forgotten.
  void start(const Request& request, Time at);

  /// Takes the transmission being heard, or the next one: characters with less silence between them than ends it. The last
  /// exchange is over; this one ends with the transmission.
  void listen(const Listening& listening, Time at);

  /// Gives up what it is doing; the exchange is over. Of a request under way the character on the line, or the one that
  /// waits out its gap, is the last: the next request begins no sooner than that one ends.
  void give_up(Time at);

  /// The station has lost power: its exchange is over, and the characters it heard are forgotten.
  void power_off(Time at);

  bool busy() const { return state_.phase != Phase::Idle; }

  /// Whether its request is on the line.
  bool sends() const { return state_.phase == Phase::Sending && state_.sent > 0; }

  /// Whether it is busy with a request and its answer, not with listening.
  bool asks() const { return busy() && !state_.request.frame.empty(); }

  const std::vector<ReceivedCharacter>& heard() const { return state_.heard; }

  /// Lets `wire` be told of each edge of the sync signal; an empty function ends that. Wiring, not state.
  void when_sync(std::function<void(bool high, Time at)> wire) { sync_wire_ = std::move(wire); }

  /// The exchange that is under way, or the last one.
  const Exchange& exchange() const { return state_.exchange; }

  /// Takes a report of the UART. `another_sends`: another master has its request on the line.
  void on(const Uart::Report& report, bool another_sends = false);
  void handle(const Event& event);

  const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }

 private:
  enum What : std::uint8_t { kBegin, kQuiet };

  void begin(const Request& request, Time at);
  void send_next(Time at);
  void sent(Time at);
  void take_first_transmission();
  void take(const ReceivedCharacter& character, bool another_sends);
  void received(const ReceivedCharacter& character, bool another_sends);
  void quiet(Time now);
  void finish();
  void drive_sync(bool high, Time at) const;
  Time silence() const;

  Uart& uart_;
  EventQueue& queue_;
  EventOwner owner_;
  State state_;
  std::function<void(bool high, Time at)> sync_wire_{};
};

}  // namespace s7200::serial
