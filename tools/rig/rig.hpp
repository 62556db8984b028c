// A PLC with everything attached: what it has kept, what drives its inputs, what disturbs its line, and what is recorded of
// it. Every verb and every test bench assembles it here.
#pragma once

#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

#include "serial_sim/system/simulation.hpp"
#include "tools/host/written_files.hpp"
#include "tools/rig/capture_files.hpp"
#include "tools/rig/plc_rig.hpp"

namespace s7200::tools {

/// As someone asks for it. `-` is standard_output, for a trace and the outputs.
struct RigSettings : PlcSettings {
  std::vector<serial::Fault> faults{};  ///< of the line, from power-up on
  std::uint32_t port = 0;               ///< of the PLC, that the line with everything on it is at
  std::vector<std::string> captures{};  ///< of the line: FILE.vcd, FILE.pcap
  std::string link{};                   ///< a pty's link: nothing is written there, and no output may have its name
  std::ostream* standard_output = nullptr;
};

class Rig final {
 public:
  /// Reads and opens all that the settings name. Null, and all of what is wrong, if something cannot be had; no file has
  /// been touched then. Signals are only noted from here on: there is something to complete.
  static std::unique_ptr<Rig> assemble(std::shared_ptr<const Program> program, const RigSettings& settings,
                                       std::vector<std::string>& problems);

  /// Time 0: the program begins with its memory, clock, assignments and faults, and the records watch it. All that runs ends
  /// early after an interruption.
  void power_up();

  serial::Simulation& simulation() { return simulation_; }
  const serial::Simulation& simulation() const { return simulation_; }
  const Cpu& cpu() const { return simulation_.cpu(); }

  /// What is read and written already.
  const WrittenFiles& files() const { return files_; }

  /// What watches the CPU; others may be added.
  FanOut& sinks() { return plc_.sinks(); }

  /// Completes the records and keeps the memory. Returns what could not be written.
  std::vector<std::string> finish();

 private:
  Rig(std::shared_ptr<const Program> program, const RigSettings& settings, serial::FieldScript field);
  bool claim_files(std::string& why);
  bool open_records(std::string& why);

  RigSettings settings_;
  WrittenFiles files_;
  PlcRig plc_;
  CaptureFiles captures_;  // outlives the simulation
  serial::Simulation simulation_;
};

}  // namespace s7200::tools
