// What `s7200 run` observes of its PLCs.
#pragma once

#include <list>
#include <nlohmann/json_fwd.hpp>

#include "tools/command/options/coverage_options.hpp"
#include "tools/coverage/observed.hpp"
#include "tools/rig/rig.hpp"

namespace s7200::tools {

/// The observers of all PLCs of a rig, which is not powered up yet and is not owned. This lives as long as the rig runs.
class RunObservers {
 public:
  RunObservers(Rig& rig, const Observed& observed);
  RunObservers(const RunObservers&) = delete;
  RunObservers& operator=(const RunObservers&) = delete;

  /// What is to be added to the results of --json.
  nlohmann::ordered_json json(const CoverageOptions& options) const;

  /// Prints and writes what was asked for, after the results. Returns `exit_code`, or a worse one after a message.
  int show(const CoverageOptions& options, bool json, int exit_code) const;

 private:
  CoverageOfPrograms coverage() const;

  std::list<PlcObservers> observers_;  // by PLC
};

}  // namespace s7200::tools
