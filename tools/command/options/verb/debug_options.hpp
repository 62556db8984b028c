// The options of `s7200 debug`, and of `s7200 dap`.
#pragma once

#include <string>
#include <vector>

#include "tools/command/options/plc/bridge_options.hpp"
#include "tools/command/options/plc/program_options.hpp"
#include "tools/command/options/plc/rig_options.hpp"
#include "tools/command/options/verb/report_option.hpp"

namespace s7200::tools {

/// A PLC to be debugged.
struct DebuggeeOptions {
  ProgramOptions program;
  serial::MasterSettings master;
  RigOptions rig;
  BridgeOptions bridge;

  void add_program_to(CLI::App& app);
  void add_plant_to(CLI::App& app);
};

struct DebugOptions : DebuggeeOptions {
  std::string commands_file;
  std::vector<std::string> commands;
  bool interactive = false;
  ReportOption report;
  std::string only, target;  ///< of a file of scenarios

  void add_to(CLI::App& app);

  /// Whether there are commands besides standard input.
  bool given() const { return !commands_file.empty() || !commands.empty(); }
};

}  // namespace s7200::tools
