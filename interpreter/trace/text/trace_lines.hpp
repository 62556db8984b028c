// What a trace says besides each instruction: every record with its reason, what got no answer and why, and the way that the
// main program took.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "interpreter/program/program.hpp"
#include "interpreter/trace/program_path.hpp"
#include "interpreter/trace/text/event_lines.hpp"
#include "interpreter/trace/trace.hpp"
#include "interpreter/trace/trace_reasons.hpp"

namespace s7200 {

/// Not what passes a PLC by while it has no power; of what is ignored up to a silence the line of the first character
/// speaks for what follows.
bool is_shown(const TraceRecord& record);

/// `8 characters`
std::string characters_text(std::size_t count);

/// `no answer to 8 characters since 2000.131000 ms: JMP 255 in line 141 (…)`
std::string unanswered_text(const TraceReasons::Unanswered& frame);

struct TraceLine {
  Time at = 0;
  std::string text;      ///< without the time
  bool trouble = false;  ///< an error, what was lost or not wanted, a frame without an answer
  std::string power{};   ///< of a frame without an answer: TraceReasons::Cause::power
};

/// It must be told every record and every instruction, in their order.
class TraceLines {
 public:
  /// The program must live as long as this.
  explicit TraceLines(const Program& program) : text_(program), reasons_(program), path_(program) {}

  std::vector<TraceLine> of(const TraceRecord& record);
  std::optional<TraceLine> of(const InstructionRecord& record);

  /// The same in two steps. The first appends `INT 123 ends: took 259.4 us`: what happened and why.
  void append_to(fmt::memory_buffer& text, const TraceRecord& record);
  /// What it means for frames and for the way.
  std::vector<TraceLine> besides(const TraceRecord& record);

  /// What it is told next need not follow on what it was told; interrupts are so then.
  void forget(const TraceReasons::Disabled& interrupts);

  /// Which way the main program takes is said anew.
  void begin_way() { path_.forget(); }

 private:
  EventText text_;
  TraceReasons reasons_;
  ProgramPath path_;
};

}  // namespace s7200
