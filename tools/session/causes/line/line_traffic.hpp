// Who sent what on a line while the past was played, and what PLCs and bridges there have heard.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "interpreter/trace/trace.hpp"
#include "tools/session/past/history.hpp"

namespace s7200::tools {

/// Characters that one on the line has sent without a pause, a PLC with one XMT after another.
struct Sent {
  std::optional<Asker> by{};  ///< nothing: that is not known
  int driver = 0;             ///< of the line
  Time from = 0;
  Time to = 0;  ///< of the last character so far
  Bytes bytes{};
  bool goes_on = false;
  std::optional<std::uint32_t> break_by{};  ///< of a PLC: the XMT with 0 characters

  bool is_of_any_plc() const { return by && by->kind == Asker::Kind::Plc; }
  bool is_of_plc(std::size_t station) const { return by == Asker{Asker::Kind::Plc, station}; }
  bool overlaps(Time begin, Time end) const { return from < end && (goes_on || to > begin); }
};

/// It must be told the records of all stations, in their order.
class LineTraffic {
 public:
  /// Of one of PlcRequests::lines(). The history must live as long as this.
  LineTraffic(const History& history, std::size_t line) : history_(history), line_(line) {}

  /// The past is about to be played, and has been.
  void begin() { since_ = history_.now().time; }
  void end();

  void note(std::size_t station, const TraceRecord& record);

  /// Between two records: a bridge may take what its port has heard.
  void note_hosts();

  /// In the order in which they began, when the past has been played.
  const std::vector<Sent>& sent() const { return sent_; }

  /// What a PLC, or a bridge, has heard from `from` until before `to`.
  std::vector<ReceivedCharacter> heard_by(const Asker& who, Time from, Time to) const;

 private:
  void note_masters();
  void note_plc(std::size_t station, const TraceRecord& record);
  void append_hosts();
  void join_frames();
  bool goes_on_with(const Sent& sent, const Sent& next) const;

  const History& history_;
  std::size_t line_;
  Time since_ = 0;
  std::vector<Sent> sent_;
  std::vector<std::pair<Asker, ReceivedCharacter>> heard_;
  std::map<std::size_t, std::size_t> waiting_;  // by host port, how many of those that it has heard are noted and not taken
};

}  // namespace s7200::tools
