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

/// What the program is asked.
struct Command {
  std::uint8_t loop = measuring::kNoLoop;
  std::uint16_t outer = 1, inner = 0;

  /// As it is sent, and as it stands in V memory.
  Bytes bytes() const;
};

/// Its answer.
struct Measured {
  std::uint16_t milliseconds = 0;
  std::uint8_t identification = 0;  ///< SMB6
  std::uint8_t loops = 0;
};

/// How many loops the program has. The last one runs scans and has no FOR.
std::size_t measured_loops(const Program& program);

/// What a loop took for one repetition, and by how much that may be wrong.
struct LoopTime {
  double ns = 0, within = 0;
  double run = 0;  ///< the whole run, with all that is around the loop, divided by the repetitions
};

struct Measurement {
  std::uint8_t identification = 0;
  std::vector<LoopTime> loops{};  ///< by their numbers, as far as it came
  std::string broken_off{};       ///< why the CPU no longer answered; empty if it did to the end, or until an interruption
};

/// Who follows it.
struct MeasurementListener {
  std::function<void()> silent;                               ///< there was no answer yet
  std::function<void(std::uint8_t identification)> answered;  ///< before the first loop; it may throw
  std::function<void(std::size_t loops)> measured;            ///< so many so far
};

/// Asks for all loops, each for about so long; once the command is interrupted, or the CPU is gone, for no more of them.
/// Throws SlaveUnreachable, and std::runtime_error if what answers first is not the program, or another version of it, or
/// nothing does.
Measurement measure_loops(Slave& slave, std::size_t loops, Time each, const MeasurementListener& listener);

}  // namespace s7200::tools
