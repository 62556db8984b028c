// A CPU that runs measure_times.stl: a real one at the end of a line, or a simulated one.
#pragma once

#include <memory>
#include <string>

#include "tools/command/options/program_options.hpp"
#include "tools/rig/rig.hpp"
#include "tools/slave/slave.hpp"

namespace s7200::tools {

class MeasuringTarget {
 public:
  /// Null after a message, with the exit code, if a program has errors. Throws std::invalid_argument for a target that
  /// cannot be asked so, SlaveUnreachable, and std::runtime_error for a program that does not get ready.
  static std::unique_ptr<MeasuringTarget> open(const std::string& target, ProgramOptions program, int& exit_code);

  Slave& slave() { return *slave_; }

 private:
  std::unique_ptr<Rig> rig_;  // of a simulated one; outlives its slave
  std::unique_ptr<Slave> slave_;
};

}  // namespace s7200::tools
