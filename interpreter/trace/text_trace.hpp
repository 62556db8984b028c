// A trace as text, to be read by people and compared with diff.
#pragma once

#include <functional>
#include <iosfwd>
#include <memory>
#include <string_view>
#include <vector>

#include "interpreter/program/program.hpp"
#include "interpreter/trace/instruction_lines.hpp"
#include "interpreter/trace/trace.hpp"
#include "interpreter/trace/trace_lines.hpp"

namespace s7200 {

/// How much a trace says.
enum class TraceDetail : std::uint8_t {
  Events,       ///< what happened, without looking at instructions: fast
  Way,          ///< and the way that the main program takes, when it changes
  Instructions  ///< and every instruction
};

/// Writes each record that is_shown() as it comes, with its reasons, and the way of the main program when it changes. Does
/// not own the stream.
class TextTrace final : public TraceSink {
 public:
  static constexpr std::string_view kFirstLine = "# time in ms   what";

  TextTrace(std::ostream& out, std::shared_ptr<const Program> program, TraceDetail detail);

  /// Hands each line on, with the instant that it is about, instead of writing them; there is no first line.
  using TakeLine = std::function<void(Time at, std::string_view line)>;
  TextTrace(TakeLine take, std::shared_ptr<const Program> program, TraceDetail detail);

  void record(const TraceRecord& record) override;
  void instruction(const InstructionRecord& record) override;
  /// What is done to the PLC from outside.
  void note(Time at, std::string_view what);

  bool wants_instructions() const override { return detail_ != TraceDetail::Events; }
  Watch watch() const override { return detail_ == TraceDetail::Instructions ? Watch::Values : Watch::Flow; }
  bool wants_scans() const override { return detail_ == TraceDetail::Instructions; }

 private:
  bool wants(const TraceRecord& record) const;
  void put_line(Time at);

  TakeLine take_;
  std::shared_ptr<const Program> program_;
  TraceDetail detail_;
  TraceLines lines_;
  InstructionLines instruction_lines_;
  fmt::memory_buffer line_;
};

}  // namespace s7200
