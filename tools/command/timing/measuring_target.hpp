// A CPU that runs measure_times.stl: a real one at the end of a line, or a simulated one.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "tools/calibration/measurement.hpp"
#include "tools/command/options/plc/program_options.hpp"
#include "tools/rig/rig.hpp"
#include "tools/slave/slave.hpp"

namespace s7200::tools {

class MeasuringTarget {
 public:
  /// Null after a message, with the exit code, if a program has errors. Throws std::invalid_argument for a target that
  /// cannot be asked so, SlaveUnreachable, and std::runtime_error for a program that does not get ready.
  static std::unique_ptr<MeasuringTarget> open(const std::string& target, ProgramOptions program, int& exit_code);

  Slave& slave() { return *slave_; }

  /// The errors of a simulated one that is in STOP; else empty.
  std::string why_it_stopped() const;

 private:
  std::unique_ptr<Rig> rig_;  // of a simulated one; outlives its slave
  std::unique_ptr<Slave> slave_;
};

/// The CPU that answers is not the one that was named.
struct WrongCpu : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Asks for all loops, each for about so long, and shows how far it is; after an interruption there are fewer, and the exit
/// code says so. `answered` hears SMB6 before the first one, and may throw WrongCpu. Nothing after a message, with the exit
/// code. Throws std::invalid_argument as open().
std::optional<Measurement> measure(const std::string& target, const ProgramOptions& program, std::size_t loops, Time each,
                                   const std::function<void(std::uint8_t identification)>& answered, int& exit_code);

/// What has to be done before, its lines joined.
std::string how_to_measure(std::string_view between);

}  // namespace s7200::tools
