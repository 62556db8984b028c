// What the programs of PLCs send, and which of it is a request: a Modbus RTU frame with a right CRC, unless it answers what
// somebody else has asked on its line. How long a program waits for its answer only the program knows; a broadcast has none.
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
#include "tools/session/past/actions/asker.hpp"

namespace s7200::tools {

/// Whether a Modbus RTU frame, of two characters at least, has the station and the function of a request.
bool may_answer(std::span<const std::uint8_t> frame, std::span<const std::uint8_t> request);

/// Whether it is a Modbus RTU frame with a right CRC, which does not answer that request.
bool asks_something_else(std::span<const std::uint8_t> frame, std::span<const std::uint8_t> request);

/// Whether it is one with a right CRC, whoever it is for.
bool is_rtu_frame(std::span<const std::uint8_t> frame);

/// Whether a record is of a character that a station hears, whatever its program makes of it.
bool is_heard(const TraceRecord& record);

/// What a PLC has sent.
struct SentByPlc {
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
    Time start = 0;                  ///< when the program began to send it
    Time end = 0;                    ///< of its last character
    std::optional<Answer> answer{};  ///< what anyone but a master has sent next, up to a silence of 3.5 characters
    bool given_up = false;           ///< its station has sent again, or somebody else has asked, before there was one; or
                                     ///< it is a broadcast, which has none
    bool waits() const { return !answer && !given_up; }
    Asker asker() const { return {Asker::Kind::Plc, station}; }

    /// What its station has heard since.
    struct Heard {
      std::vector<std::uint8_t> bytes{};
      Time to = 0;
      bool parity_error = false, framing_error = false;  ///< of any character
    };
    Heard heard{};
  };

  /// A request of a master in the simulation, or of a PLC that has not waited for its answer: the answer may come when
  /// somebody asks the next station already.
  struct Asked {
    Time start = 0;
    std::vector<std::uint8_t> frame{};
    std::optional<std::size_t> by{};  ///< the station of the PLC
    bool answered = false;
  };

  /// What a port hears, without a pause of 3.5 characters.
  struct Hearing {
    std::vector<std::uint8_t> bytes{};  ///< the first of them, if it never ends
    Time to = 0;
  };

  /// Plain, so that a snapshot is a copy.
  struct State {
    std::vector<std::array<Hearing, kPorts.size()>> hearing;                   ///< by station and port
    std::vector<std::array<std::optional<SentByPlc>, kPorts.size()>> sending;  ///< by station and port
    std::vector<std::optional<Request>> last;                                  ///< by line, of a PLC
    std::vector<std::optional<Request>> before;                                ///< the one before that
    std::vector<std::vector<Asked>> asked;                                     ///< by line, the last few in their order
  };

  explicit PlcRequests(Others others);

  /// Must be told the records of all stations, in their order.
  void note(std::size_t station, const TraceRecord& record);

  /// The lines of all ports, each once; the same order in every run.
  const std::vector<const serial::SharedLine*>& lines() const { return lines_; }
  std::size_t line_of(std::size_t station, std::uint8_t port) const;

  /// The port of a station that is on a line; nothing if none is.
  std::optional<std::uint8_t> port_on(std::size_t line, std::size_t station) const;

  /// The masters in the simulation that are on a line.
  const std::vector<SimulatedMaster>& masters_on(std::size_t line) const { return masters_[line]; }

  /// The last request of a PLC on a line; nothing if there was none.
  const std::optional<Request>& last(std::size_t line) const { return state_.last[line]; }

  /// The one before that.
  const std::optional<Request>& before(std::size_t line) const { return state_.before[line]; }

  /// Whether the request that waits on the line of that station is given up with this record, which was not noted yet: its
  /// own station sends again, or another PLC has sent one, or the first character of a master's is heard.
  bool gives_up(std::size_t station, const TraceRecord& record) const;

  /// Whether this record, which was not noted yet, is the end of a request.
  bool ends_request(std::size_t station, const TraceRecord& record) const;

  /// Whether a PLC is sending on a line: whether that is an answer shows at its end.
  bool is_sending(std::size_t line) const;

  /// A simulated master of the line has begun to ask then or later, and is not done.
  bool master_asks(std::size_t line, Time since) const;

  /// What a port is sending, from the first character on; nothing if it sends nothing.
  const std::optional<SentByPlc>& sending(std::size_t station, std::uint8_t port) const {
    return state_.sending[station].at(port);
  }

  /// What a port has heard last, or hears.
  const Hearing& heard(std::size_t station, std::uint8_t port) const { return state_.hearing[station].at(port); }

  const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }
  /// Nothing has been sent yet.
  void forget();

 private:
  void note_sender(std::size_t station, const TraceRecord& record);
  void note_end(std::size_t station, std::uint8_t port, SentByPlc sent);
  void note_hearing(std::size_t station, const TraceRecord& record);
  void note_heard(std::size_t station, const TraceRecord& record);
  void note_masters(std::size_t line);
  void note_asked(std::size_t line, Asked asked);
  std::vector<SimulatedMaster> find_masters_on(const serial::SharedLine& line) const;
  bool is_late_answer(std::size_t station, std::size_t line, Frame sent) const;
  bool is_request(std::size_t station, std::uint8_t port, const SentByPlc& sent) const;
  bool has_asked(const serial::Requester& requester, const SentByPlc& answer) const;
  bool is_answer(std::size_t station, std::uint8_t port, const SentByPlc& sent) const;

  Others others_;
  std::vector<const serial::SharedLine*> lines_;
  std::vector<std::vector<SimulatedMaster>> masters_;  // by line
  State state_;
};

/// Why the answer to a request cannot be taken: `damage` of its characters, or, to a Modbus RTU request, that it is none.
/// What another protocol makes of it is not known. Empty if nothing is wrong; an exception is an answer.
std::string wrong_with(std::span<const std::uint8_t> request, std::span<const std::uint8_t> answer, std::string_view damage);

}  // namespace s7200::tools
