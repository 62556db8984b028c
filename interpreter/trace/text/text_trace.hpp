// A trace as text, to be read by people and compared with diff.
#pragma once

#include <iosfwd>
#include <memory>
#include <string_view>
#include <vector>

#include "interpreter/program/program.hpp"
#include "interpreter/trace/text/instruction_lines.hpp"
#include "interpreter/trace/text/trace_lines.hpp"
#include "interpreter/trace/trace.hpp"
#include "interpreter/trace/trace_writer.hpp"

namespace s7200 {

/// Writes each record that is_shown() as it comes, with its reasons, and the way of the main program when it changes. Does
/// not own the stream.
class TextTrace final : public TraceWriter {
 public:
  static constexpr std::string_view kFirstLine = "# time in ms   what";

  TextTrace(std::ostream& out, std::shared_ptr<const Program> program, TraceDetail detail);

  /// Hands each line on, with the instant that it is about, instead of writing them; there is no first line.
  TextTrace(TakeLine take, std::shared_ptr<const Program> program, TraceDetail detail);

  void record(const TraceRecord& record) override;
  void instruction(const InstructionRecord& record) override;
  void note(Time at, std::string_view what) override;

 private:
  void put_line(Time at);

  TakeLine take_;
  std::shared_ptr<const Program> program_;
  TraceLines lines_;
  InstructionLines instruction_lines_;
  fmt::memory_buffer line_;
};

}  // namespace s7200
