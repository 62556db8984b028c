// The forms in which a trace is written: a row each. The name of the file says which.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "interpreter/program/program.hpp"
#include "interpreter/trace/trace_writer.hpp"

namespace s7200::tools {

struct TraceFormat {
  std::string_view extension;  ///< of the files that have this form; empty: of all others

  /// The first line of a file, by which it is known again, with its end: of one PLC, and of a system.
  std::string_view first_line, first_line_of_system;

  /// `station`: empty where there is one PLC.
  std::unique_ptr<TraceWriter> (*writer)(TakeLine take, std::shared_ptr<const Program> program, TraceDetail detail,
                                         const std::string& station);

  /// A line for what is done to a station or a line of a system from outside.
  std::string (*note)(Time at, std::string_view station, std::string_view what);

  /// Whether lines of a system have a column with the station's name before them, which is not the writer's.
  bool station_column;
};

const TraceFormat& trace_format_of(const std::string& path);

}  // namespace s7200::tools
