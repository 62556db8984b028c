// The options of `s7200 run`.
#pragma once

#include "tools/command/options/plc/bridge_options.hpp"
#include "tools/command/options/plc/other_plc_options.hpp"
#include "tools/command/options/plc/program_options.hpp"
#include "tools/command/options/plc/rig_options.hpp"
#include "tools/command/options/verb/coverage_options.hpp"
#include "tools/command/options/verb/profile_options.hpp"
#include "tools/command/options/verb/report_option.hpp"

namespace s7200::tools {

struct RunOptions {
  ProgramOptions program;
  Time duration = kNever;  // kNever: a second, or as many scans as asked for, or with a bridge without end
  std::uint64_t scans = 0;
  bool json = false;
  BridgeOptions bridge;
  RigOptions rig;
  CoverageOptions coverage;
  ProfileOptions profile;
  ReportOption report;
  const Protocol* protocol = nullptr;  ///< of westinghouse:MODEL
  OtherPlcOptions other;
  std::vector<CLI::Option*> for_other_plcs;  ///< that nothing else has a use for

  /// Whether the run ends by itself. One that `serves` masters outside does not unless it was told when.
  bool has_end(bool serves) const { return duration != kNever || scans != 0 || !serves; }
  Time end(bool serves) const { return duration == kNever && scans == 0 && !serves ? kSecond : duration; }
  void add_to(CLI::App& app);
};

}  // namespace s7200::tools
