// What is kept of one PLC on files: its retentive memory and its records.
#pragma once

#include <list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "interpreter/base/result.hpp"
#include "interpreter/trace/text/text_trace.hpp"
#include "serial_sim/line/wire_tap.hpp"
#include "serial_sim/system/plc.hpp"
#include "tools/host/files/written_files.hpp"
#include "tools/plan/system_plan.hpp"
#include "tools/rig/files/memory_file.hpp"
#include "tools/rig/files/trace_files.hpp"

namespace s7200::tools {

/// claim(), read_memory(), open(), put(), and after the run close() and keep_memory(). What can fail brings trouble, or adds
/// to `problems`.
class PlcFiles {
 public:
  /// Of a PLC that has not had power yet.
  PlcFiles(const PlcPlan& plan, const serial::Plc& plc);

  Result<> claim(WrittenFiles& files);

  /// Reads the memory with which the PLC powers up first; nothing if there is none.
  Result<> read_memory(std::optional<RetentiveMemory>& kept);

  /// The records go on to be told what the CPU does by `sinks`.
  Result<> open(FanOut& sinks) { return traces_.open(sinks); }
  Result<> put() { return traces_.put(); }

  /// What is told of the wires at a port for the trace; null if the trace does not show its levels.
  serial::WireSink* levels_at(std::uint8_t port);

  /// Writes into the trace what is done to the PLC from outside.
  void note(Time at, std::string_view what) {
    if (trace_) trace_->note(at, what);
  }

  void flush() { traces_.flush(); }
  void add_sizes(std::vector<RecordSize>& sizes) const { traces_.add_sizes(sizes); }
  void close(std::vector<std::string>& problems) {
    if (trace_) trace_->finish();
    traces_.close(problems);
  }
  void keep_memory(std::vector<std::string>& problems) const;

 private:
  /// The wires at a port, as the trace shows them.
  struct Levels final : serial::WireSink {
    Levels(TraceWriter& of, std::uint8_t number) : trace(of), port(number) {}
    void edge(serial::Wire wire, Time at, bool mark, int driver) override;
    void settled(Time until, const SerialFormat& format) override;
    void finish() override {}
    TraceWriter& trace;
    std::uint8_t port;
  };

  std::shared_ptr<const Program> program_;
  PlcSettings settings_;
  const serial::Plc& plc_;
  MemoryFile memory_;
  TraceFiles traces_;
  TraceWriter* trace_ = nullptr;  // null: none is written
  std::list<Levels> levels_{};
};

}  // namespace s7200::tools
