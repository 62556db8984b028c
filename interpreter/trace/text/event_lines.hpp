// Trace records as text. What comes again and again, such as the name of an event, is made once.
#pragma once

#include <fmt/format.h>

#include <array>
#include <string>

#include "interpreter/model/events.hpp"
#include "interpreter/program/program.hpp"
#include "interpreter/trace/trace.hpp"

namespace s7200 {

/// What happened, in words, without what made the program do it.
class EventText {
 public:
  /// The program must live as long as this.
  explicit EventText(const Program& program) : program_(program) {}

  /// Appends `INT 122 begins: event 8 (…), waited 12 us`.
  void append_to(fmt::memory_buffer& text, const TraceRecord& record);

  /// `event 8 (…)`
  const std::string& event(std::uint8_t number);
  /// `12 us`
  const std::string& duration(Time time);
  /// `line 42: MOVW VW0, AC0`, the statement of an instruction; `between two scans` for kNoRoutine.
  std::string place(std::uint32_t op) const;

 private:
  struct Duration {
    Time time = -1;
    std::string text;
  };

  const Program& program_;
  std::array<std::string, kEvents> events_;
  std::array<Duration, 64> durations_;  ///< the last ones, each at a place of its own
};

/// One line for a record, without the time and the line end: `INT 122 begins: event 8 (…), waited 12 us`.
std::string describe(const TraceRecord& record, const Program& program);

}  // namespace s7200
