// What `s7200 run` observes of its PLCs.
#pragma once

#include <list>
#include <nlohmann/json_fwd.hpp>

#include "tools/command/options/verb/run_options.hpp"
#include "tools/coverage/observed.hpp"
#include "tools/rig/rig.hpp"

namespace s7200::tools {

/// The observers of all PLCs of a rig, which is not powered up yet and is not owned. This lives as long as the rig runs.
class RunObservers {
 public:
  RunObservers(Rig& rig, const RunOptions& options);
  RunObservers(const RunObservers&) = delete;
  RunObservers& operator=(const RunObservers&) = delete;

  /// What is to be added to the results of --json.
  nlohmann::ordered_json json(const RunOptions& options) const;

  /// Prints and writes what was asked for, after the results. Returns `exit_code`, or a worse one after a message.
  int show(const RunOptions& options, int exit_code) const;

 private:
  CoverageOfPrograms coverage() const;
  ProfileOfPrograms profile() const;

  struct ObservedPlc {
    std::string plc;  // its name; empty of the only one
    PlcObservers observers;
  };
  std::list<ObservedPlc> observed_;
};

}  // namespace s7200::tools
