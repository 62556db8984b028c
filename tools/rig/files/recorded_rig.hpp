// A rig with the files that its plan names: what its PLCs have kept, and what is recorded of it.
#pragma once

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <list>
#include <memory>
#include <string>
#include <vector>

#include "interpreter/base/result.hpp"
#include "serial_sim/line/wire_fan_out.hpp"
#include "tools/host/files/written_files.hpp"
#include "tools/rig/files/capture_files.hpp"
#include "tools/rig/files/plc_files.hpp"
#include "tools/rig/files/system_trace.hpp"
#include "tools/rig/rig.hpp"

namespace s7200::tools {

/// What a rig is told besides its plan.
struct RigSurroundings {
  std::string path{};                       ///< of the system file
  std::string link{};                       ///< a pty's link: nothing is written there, and no output may have its name
  std::ostream* standard_output = nullptr;  ///< `-` for a trace and the outputs
  std::string trace{};                      ///< of a system, all its PLCs in one file
  TraceDetail trace_detail = TraceDetail::Way;
  std::uint64_t record_limit = kRecordLimit;
  RigSpots seen{};
  StopToken stop{};               ///< ends what runs
  std::function<void()> begun{};  ///< told when all has been read, before files are written
};

/// The files of a rig. They outlive its system.
struct RigFiles {
  WrittenFiles written;
  std::unique_ptr<SystemTrace> trace{};  ///< null: none
  std::list<PlcFiles> plcs{};
  std::list<CaptureFiles> captures{};  ///< by line
  std::list<serial::WireFanOut> wires{};
};

class RecordedRig final : private RigFiles, public Rig {
 public:
  /// Reads and opens all files that the plan and its surroundings name. Returns null with all `problems` if one of them
  /// cannot be opened; then no file has been changed.
  static std::unique_ptr<RecordedRig> assemble(SystemPlan plan, const RigSurroundings& surroundings,
                                               std::vector<std::string>& problems);

  /// The files that are read and written already.
  const WrittenFiles& files() const { return written; }

  /// Writes the records so far to their files, for readers who follow a run in real time. A trace of a system is a second
  /// behind.
  void flush_records();

  /// How far the records have grown that are files.
  std::vector<RecordSize> record_sizes() const;

  /// Completes the records and keeps the memories of the PLCs that have had power. Returns what could not be written.
  std::vector<std::string> finish();

 private:
  RecordedRig(SystemPlan plan, const RigSurroundings& surroundings);
  Result<> claim_files(const RigSurroundings& surroundings);
  Result<> read_memories();
  Result<> open_records();
  void watch_lines();
  void watch_ports(std::size_t number, PlcFiles& files);
  void listen();
};

}  // namespace s7200::tools
