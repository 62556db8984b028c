// What run, send and master have in common: the plant around the CPU. Memory and inputs before and during a run, faults of
// its line, what is recorded of it, what is kept and shown after it.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "interpreter/trace/fan_out.hpp"
#include "tools/rig/capture_files.hpp"
#include "tools/command/options/fault_options.hpp"
#include "tools/views/memory.hpp"
#include "tools/rig/memory_file.hpp"
#include "tools/rig/output_file.hpp"
#include "tools/rig/trace_file.hpp"

namespace CLI {
class App;
}

namespace s7200::tools {

class PlantOptions {
 public:
  void add_to(CLI::App& app);

  /// Reads and opens what the options name. False after a message. `json`: standard output is taken; `link`: so is this
  /// name, by --pty. Signals are only noted from then on: there is something to complete.
  bool prepare(const std::shared_ptr<const Program>& program, bool json, const std::string& link = {});

  /// What drives the inputs; for the Simulation.
  const serial::FieldScript& field() const { return field_; }

  /// Powers up with the memory, sets the clock and the assignments, injects the faults, and lets the records watch.
  void power_up(serial::Simulation& simulation);

  /// What watches the CPU; another sink may be added.
  FanOut& sinks() { return sinks_; }

  /// Whether there are faults.
  bool faulted() const { return !faults_.empty(); }

  /// Completes the records and keeps the memory. False after a message.
  bool finish(const serial::Simulation& simulation);

  /// --strict: whether a run-time error ends it all.
  bool strict() const { return strict_; }

  /// With --strict, whether there was one.
  bool failed_strictly(const Cpu& cpu) const { return strict_ && cpu.state().error_count != 0; }

  /// The memory asked for with --dump.
  std::string dump_text(const Cpu& cpu) const;

  /// How the PLC was left: mode, errors, faults, and the memory asked for.
  nlohmann::ordered_json json(const serial::Simulation& simulation) const;

  /// The same without a PLC.
  static nlohmann::ordered_json no_json();

 private:
  bool read_field(const CpuModel& model);
  bool claim_files(const Program& program, const std::string& link);
  bool open_records(const std::shared_ptr<const Program>& program);

  std::vector<std::string> set_, dump_;
  std::string input_path_;
  std::optional<ClockTime> clock_;
  bool strict_ = false;
  TraceFile trace_;
  OutputFile output_;
  CaptureFiles captures_;
  MemoryFile memory_;
  FaultOptions faults_;

  std::vector<Assignment> assignments_;
  std::vector<MemoryRange> dumps_;
  serial::FieldScript field_;
  FanOut sinks_;
};

}  // namespace s7200::tools
