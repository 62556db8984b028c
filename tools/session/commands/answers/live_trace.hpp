// The trace that is shown while a session runs: `trace on`.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "interpreter/trace/text/trace_lines.hpp"

namespace s7200::tools {

class Session;

class LiveTrace {
 public:
  explicit LiveTrace(Session& session) : session_(session) {}

  /// A station more, by its number.
  void add(const Program& program) { lines_.emplace_back(program); }

  bool is_on() const { return on_; }
  void turn(bool on);

  /// Before something is traced: it is told what was before.
  void follow();
  /// What comes does not go on where it was.
  void lose_the_way() { follows_ = false; }

  void note(std::size_t station, const TraceRecord& record);
  void note(std::size_t station, const InstructionRecord& record);

  /// Tells what has happened before `until`.
  void write(Time until);

 private:
  void tell(std::size_t station, const std::vector<TraceLine>& lines);
  void tell_line(const TraceLine& line);

  Session& session_;
  std::deque<TraceLines> lines_{};    // by station
  std::vector<TraceLine> waiting_{};  // of a system: others may come before them
  bool on_ = false;
  bool follows_ = false;  // it has been told all that was before where it stands
};

}  // namespace s7200::tools
