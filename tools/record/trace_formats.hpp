// The forms in which a trace is written: a row each. The name of the file says which.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/cpu/state.hpp"
#include "interpreter/program/program.hpp"
#include "interpreter/trace/signals.hpp"
#include "interpreter/trace/trace_writer.hpp"

namespace s7200::tools {

/// What a writer of a trace is given.
struct TraceWanted {
  TakeLine take{};
  std::shared_ptr<const Program> program{};
  TraceDetail detail = TraceDetail::Way;
  std::string station{};          ///< empty where there is one PLC
  std::vector<Signal> signals{};  ///< for forms that show them
  /// The state of the CPU whose memory signals are read from; null as long as it has no power. Left out without signals.
  std::function<const State*()> state{};
};

struct TraceFormat {
  std::string_view extension;  ///< of the files that have this form; empty: of all others

  /// The first line of a file, by which it is known again, with its end: of one PLC, and of a system.
  std::string_view first_line, first_line_of_system;

  std::unique_ptr<TraceWriter> (*writer)(TraceWanted wanted);

  /// What it makes of signals.
  enum class Signals : std::uint8_t { None, Some, Needed };
  Signals signals;

  /// A line for what is done to a station or a line of a system from outside; null: systems are not written so.
  std::string (*note)(Time at, std::string_view station, std::string_view what);

  /// Whether lines of a system have a column with the station's name before them, which is not the writer's.
  bool station_column;
};

const TraceFormat& trace_format_of(const std::string& path);

/// Why a trace with these signals is not written so; empty if it is.
std::string why_not_signals(const TraceFormat& format, const std::vector<Signal>& signals);

}  // namespace s7200::tools
