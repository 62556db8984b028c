// Exchanges with every table of a band: how `send` and `master` run them and what they show.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/command/options/plc/rig_options.hpp"
#include "tools/command/options/verb/band_options.hpp"
#include "tools/command/reports/run_recorder.hpp"

namespace s7200::tools {

struct BandExchanges {
  /// Of each exchange.
  struct Label {
    std::string text;
    std::string value;  ///< in the JSON
  };

  std::string verb;  ///< for the JSON
  std::string key;   ///< of what is asked, there
  std::vector<Label> labels;
  std::string good;  ///< the verdict that is wanted

  /// Does them on a rig that has been powered up; those not come to may be missing at the end. `recorder` may be null.
  std::function<std::vector<BandOutcome>(Rig& rig, const std::string& program, LostEvents& lost, RunRecorder* recorder)> run;
};

/// Does them with each table and prints what came of it; a report has the run with the first table with which not all went
/// well, else with the one in use. Returns how to end: kFine if all went well with every table.
/// Throws std::invalid_argument for options that are about one run.
int run_band(const BandOptions& band, const ProgramOptions& program, RigOptions& rig, ReportOption& report, bool json,
             const BandExchanges& exchanges);

}  // namespace s7200::tools
