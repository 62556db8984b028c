// What the programs of PLCs send, and which of it is a request: a Modbus RTU frame with a right CRC to one station, unless
// it answers what somebody else has asked on its line. How long a program waits for its answer only the program knows.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "interpreter/model/ports.hpp"
#include "interpreter/trace/trace.hpp"
#include "serial_sim/system/simulation.hpp"

namespace s7200::tools {

/// Whether a Modbus RTU frame, of two characters at least, has the station and the function of a request.
bool may_answer(std::span<const std::uint8_t> frame, std::span<const std::uint8_t> request);

/// Whether it is a Modbus RTU frame to one station with a right CRC, which does not answer that request.
bool asks_something_else(std::span<const std::uint8_t> frame, std::span<const std::uint8_t> request);

/// What a PLC has sent.
struct Transmission {
  Time from = 0, to = 0;
  std::vector<std::uint8_t> bytes{};
};

class PlcRequests {
 public:
  using Frame = std::span<const std::uint8_t>;

  /// What it has to know of the others on the lines. Wiring, not state; nothing is owned.
  struct Others {
    std::vector<serial::Simulation*> stations;     ///< the PLCs
    std::vector<const serial::Poller*> pollers{};  ///< masters that poll
    /// Whether the last frame of a bridge on the line is so, if it ended after that instant.
    std::function<bool(const serial::Line& line, Time after, const std::function<bool(Frame)>& is)> host_has_sent;
  };

  struct Request {
    struct Answer {
      Time from = 0, to = 0;
    };

    std::size_t station = 0;  ///< that asks
    std::vector<std::uint8_t> frame{};
    Time end = 0;                    ///< of its last character
    std::optional<Answer> answer{};  ///< what anyone but a master has sent next, up to a silence of 3.5 characters
    bool given_up = false;           ///< its station has sent again, or somebody else has asked, before there was one
    bool waits() const { return !answer && !given_up; }
  };

  /// Plain, so that a snapshot is a copy.
  struct State {
    std::vector<std::array<std::optional<Transmission>, kPorts.size()>> sending;  ///< by station and port
    std::vector<std::optional<Request>> last;                                     ///< by line, of a PLC
  };

  explicit PlcRequests(Others others);

  /// Must be told the records of all stations, in their order.
  void note(std::size_t station, const TraceRecord& record);

  /// The lines of all ports, each once; the same order in every run.
  const std::vector<const serial::SharedLine*>& lines() const { return lines_; }
  std::size_t line_of(std::size_t station, std::uint8_t port) const;

  /// The last request of a PLC on a line; nothing if there was none.
  const std::optional<Request>& last(std::size_t line) const { return state_.last[line]; }

  /// Whether the request that waits on the line of that station is given up with this record, which was not noted yet: its
  /// own station sends again, or a PLC has sent a request of its own, or the first character of a master's is heard.
  bool gives_up(std::size_t station, const TraceRecord& record) const;

  /// Whether this record, which was not noted yet, is the end of a request.
  bool ends_request(std::size_t station, const TraceRecord& record) const;

  /// Whether a PLC is sending on a line: whether that is an answer shows at its end.
  bool is_sending(std::size_t line) const;

  /// A simulated master of the line has begun to ask then or later, and is not done.
  bool master_asks(const serial::Line& line, Time since) const;

  /// What a port is sending, from the first character on; nothing if it sends nothing.
  const std::optional<Transmission>& sending(std::size_t station, std::uint8_t port) const {
    return state_.sending[station].at(port);
  }

  const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }
  /// Nothing has been sent yet.
  void forget();

 private:
  void note_sender(std::size_t station, const TraceRecord& record);
  void note_end(std::size_t station, std::uint8_t port, Transmission sent);
  void note_heard(std::size_t station, const TraceRecord& record);
  bool is_request(std::size_t station, std::uint8_t port, const Transmission& sent) const;
  bool has_asked(const serial::Requester& requester, const Transmission& answer) const;
  bool is_answer(std::size_t station, std::uint8_t port, const Transmission& sent) const;

  Others others_;
  std::vector<const serial::SharedLine*> lines_;
  State state_;
};

}  // namespace s7200::tools
