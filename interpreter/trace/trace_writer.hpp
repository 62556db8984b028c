// A trace that is written line by line.
#pragma once

#include <cstdint>
#include <functional>
#include <string_view>

#include "interpreter/trace/signals.hpp"
#include "interpreter/trace/text/trace_lines.hpp"
#include "interpreter/trace/trace.hpp"

namespace s7200 {

/// How much a trace says.
enum class TraceDetail : std::uint8_t {
  Events,       ///< what happened, without looking at instructions: fast
  Way,          ///< and the way that the main program takes, when it changes
  Instructions  ///< and every instruction
};

/// Takes a line of a trace, with its end, and the instant that it is about.
using TakeLine = std::function<void(Time at, std::string_view line)>;

class TraceWriter : public TraceSink {
 public:
  explicit TraceWriter(TraceDetail detail) : detail_(detail) {}

  /// Writes what is done to the PLC from outside, in words.
  virtual void note(Time at, std::string_view what) = 0;

  /// A level at a port is `mark` from `at` on. Only signals show it.
  virtual void level(std::uint8_t /*port*/, PortLevel /*level*/, Time /*at*/, bool /*mark*/) {}

  /// All levels at the port before `until` have been told, and all that the CPU did before it.
  virtual void settled(std::uint8_t /*port*/, Time /*until*/) {}

  /// The run is over: writes what ends the file, if its form has that.
  virtual void finish() {}

  bool wants_instructions() const override { return detail_ != TraceDetail::Events; }
  Watch watch() const override { return has_instructions() ? Watch::Values : Watch::Flow; }
  bool wants_scans() const override { return has_instructions(); }

 protected:
  bool has_instructions() const { return detail_ == TraceDetail::Instructions; }
  bool has(const TraceRecord& record) const {
    return record.kind == TraceKind::ScanBegin ? has_instructions() : is_shown(record);
  }

 private:
  TraceDetail detail_;
};

}  // namespace s7200
