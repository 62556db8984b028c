// The surroundings of one PLC: its retentive memory, the script that drives its inputs, and its records.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "interpreter/program/address.hpp"
#include "interpreter/trace/text_trace.hpp"
#include "serial_sim/system/plc.hpp"
#include "tools/host/written_files.hpp"
#include "tools/rig/memory_file.hpp"
#include "tools/rig/trace_files.hpp"

namespace s7200::tools {

/// The files of a PLC by their names, "" for none.
struct PlcSettings {
  std::vector<Assignment> set{};     ///< memory and input points, before the first scan
  std::string input{};               ///< inputs over time, as CSV
  std::optional<ClockTime> clock{};  ///< time of day at power-up
  std::int32_t clock_error = 0;      ///< of its crystal, in millionths; positive: it is too fast
  Time starts = 0;                   ///< when it is powered up
  MemorySettings memory{};           ///< read at power-up, written by keep_memory()
  std::string trace{};
  TraceDetail trace_detail = TraceDetail::Way;
  std::string output{};              ///< changes of outputs, as CSV; to FILE.vcd as a Value Change Dump
  std::vector<MemoryRange> dumps{};  ///< shown at the end
  std::vector<std::string> dump_names{};
};

/// Reads a script of inputs; nothing, with `problems` set, if the file is not such a script. An empty path is an empty
/// script.
std::optional<serial::FieldScript> read_field(const std::string& path, const CpuModel& model,
                                              std::vector<std::string>& problems);

/// claim(), read_memory(), open(), put(), power_up(), and after the run close() and keep_memory(). What can fail returns
/// false and sets `why`, or adds to `problems`.
class PlcRig {
 public:
  PlcRig(std::shared_ptr<const Program> program, const PlcSettings& settings);

  bool claim(WrittenFiles& files, std::string& why);
  bool read_memory(std::string& why);
  bool open(std::string& why) { return traces_.open(why); }
  bool put(std::string& why) { return traces_.put(why); }

  /// Gives the PLC power for the first time, at `at`: the program begins with its memory, clock and assignments, and the
  /// records watch it.
  void power_up(serial::Plc& plc, Time at);

  /// Writes into the trace what is done to the PLC from outside.
  void note(Time at, std::string_view what) {
    if (trace_) trace_->note(at, what);
  }

  /// The sinks that watch the CPU; others may be added.
  FanOut& sinks() { return traces_.sinks(); }

  void flush() { traces_.flush(); }
  void close(std::vector<std::string>& problems) { traces_.close(problems); }
  void keep_memory(const Cpu& cpu, std::vector<std::string>& problems) const;

 private:
  std::shared_ptr<const Program> program_;
  PlcSettings settings_;
  MemoryFile memory_;
  TraceFiles traces_;
  TraceWriter* trace_ = nullptr;  // null: none is written
};

}  // namespace s7200::tools
