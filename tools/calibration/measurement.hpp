// Asking the measuring program, wherever it runs, how long its loops take.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "interpreter/base/bytes.hpp"
#include "interpreter/program/program.hpp"
#include "tools/calibration/measure_protocol.hpp"
#include "tools/slave/slave.hpp"

namespace s7200::tools {

/// A command to the program.
struct Command {
  std::uint8_t loop = measuring::kNoLoop;
  std::uint16_t outer = 1, inner = 0;

  /// The command's bytes as they are sent, and as they stand in V memory.
  Bytes bytes() const;
};

/// The program's answer to a command.
struct Measured {
  std::uint16_t milliseconds = 0;
  std::uint8_t identification = 0;  ///< SMB6
  std::uint8_t loops = 0;
};

/// The number of the program's loops. The last one runs scans and has no FOR.
std::size_t measured_loops(const Program& program);

/// The time of one repetition of a loop, and its possible error.
struct LoopTime {
  double ns = 0, within = 0;
  double run = 0;  ///< the whole run, with all that is around the loop, divided by the repetitions
};

struct Measurement {
  std::uint8_t identification = 0;
  std::vector<LoopTime> loops{};  ///< by their numbers, as far as it came
  std::string broken_off{};       ///< why the CPU no longer answered; empty if it did to the end, or until an interruption
};

/// A listener that follows the measurement.
struct MeasurementListener {
  std::function<void()> silent;                               ///< called while there is no answer yet
  std::function<void(std::uint8_t identification)> answered;  ///< before the first loop; it may throw
  std::function<void(std::size_t loops)> measured;            ///< called with the number of loops so far
};

/// Measures all loops, each for about `each`; stops early once the command is interrupted or the CPU is gone. Throws
/// SlaveUnreachable, and std::runtime_error if the first answer is not from the program, or from another version of it, or
/// if there is none.
Measurement measure_loops(Slave& slave, std::size_t loops, Time each, const MeasurementListener& listener);

}  // namespace s7200::tools
