// The surroundings of one PLC: its retentive memory, the script that drives its inputs, and its records.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "interpreter/trace/text_trace.hpp"
#include "serial_sim/system/plc.hpp"
#include "tools/host/written_files.hpp"
#include "tools/plan/system_plan.hpp"
#include "tools/rig/memory_file.hpp"
#include "tools/rig/trace_files.hpp"

namespace s7200::tools {

/// claim(), read_memory(), open(), put(), power_up(), and after the run close() and keep_memory(). What can fail returns
/// false and sets `why`, or adds to `problems`.
class PlcRig {
 public:
  explicit PlcRig(const PlcPlan& plan);

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

  /// The memory with which the PLC powers up first; null if nothing was kept.
  const RetentiveMemory* kept() const { return kept_ ? &*kept_ : memory_.memory(); }

  /// The sinks that watch the CPU; others may be added.
  FanOut& sinks() { return traces_.sinks(); }

  void flush() { traces_.flush(); }
  void close(std::vector<std::string>& problems) {
    if (trace_) trace_->finish();
    traces_.close(problems);
  }
  void keep_memory(const Cpu& cpu, std::vector<std::string>& problems) const;

 private:
  std::shared_ptr<const Program> program_;
  PlcSettings settings_;
  std::optional<RetentiveMemory> kept_;
  MemoryFile memory_;
  TraceFiles traces_;
  TraceWriter* trace_ = nullptr;      // null: none is written
  const serial::Plc* plc_ = nullptr;  // null before it is powered up
};

}  // namespace s7200::tools
