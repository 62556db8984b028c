// What came and went on a station's line: the characters that its program did not get, what the PLCs sent, and what the
// simulated master has heard of a request's answer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "interpreter/trace/trace.hpp"
#include "interpreter/trace/trace_lines.hpp"
#include "tools/debugger/history.hpp"

namespace s7200::tools {

/// It must be told the records of all stations and the requests of the master, in their order.
class LineAccount {
 public:
  /// The history must live as long as this.
  LineAccount(History& history, std::size_t station);

  void note(std::size_t station, const TraceRecord& record);

  /// The master is about to begin a request.
  void note_request() { faults_before_ = here().faults().state(); }

  /// Characters of a frame that no routine got, all for the same reason, and that the PLC has sent nothing after.
  struct Untaken {
    TraceRecord first{};
    std::size_t characters = 0;
    Time end = 0;  ///< of the last
  };
  const std::vector<Untaken>& untaken() const { return untaken_; }

  /// Whether the PLC has heard anything that began at `from` or later.
  bool has_heard_since(Time from) const { return heard_ >= from; }

  /// What has become of a request of the master, and of what the PLC sent for it, if the line is to blame: nothing as long
  /// as the request or an answer is under way.
  std::optional<TraceLine> lost(const serial::Exchange& exchange) const;

 private:
  struct Transmission {
    std::size_t station = 0;
    Time from = 0, to = 0;
    std::vector<std::uint8_t> bytes{};
  };

  serial::Simulation& here() const { return history_.station(station_); }
  bool is_on_line(std::size_t station, const TraceRecord& record) const;
  bool is_over(const serial::Exchange& exchange) const;
  Transmission answer_to(const serial::Exchange& exchange) const;
  std::optional<TraceLine> lost_request(const serial::Exchange& exchange) const;
  std::string reasons(const serial::Exchange& exchange, const Transmission& answer) const;
  void note_untaken(const TraceRecord& record);

  History& history_;
  std::size_t station_;
  std::vector<Untaken> untaken_;
  Time heard_ = -1;  // start edge of the last character
  std::vector<Transmission> sent_;
  serial::Faults::State faults_before_;  // the last request
};

}  // namespace s7200::tools
