// A trace as text: one line for each record, to be read by people and compared with diff.
#pragma once

#include <iosfwd>
#include <memory>
#include <string>
#include <string_view>

#include "interpreter/program/program.hpp"
#include "interpreter/trace/event_lines.hpp"
#include "interpreter/trace/instruction_lines.hpp"
#include "interpreter/trace/trace.hpp"

namespace s7200 {

/// Milliseconds with six decimals: exact to the nanosecond, and columns stay aligned for an hour.
std::string clock_text(Time at);

/// Writes each record as it comes. Does not own the stream.
class TextTrace final : public TraceSink {
 public:
  static constexpr std::string_view kFirstLine = "# time in ms   what";

  TextTrace(std::ostream& out, std::shared_ptr<const Program> program, bool instructions);

  void record(const TraceRecord& record) override;
  void instruction(const InstructionRecord& record) override;
  bool wants_instructions() const override { return instructions_; }
  bool wants_scans() const override { return instructions_; }

 private:
  std::ostream& out_;
  std::shared_ptr<const Program> program_;
  bool instructions_;
  EventLines event_lines_;
  InstructionLines instruction_lines_;
  fmt::memory_buffer line_;
};

}  // namespace s7200
