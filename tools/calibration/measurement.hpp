// Asking the measuring program, wherever it runs, how long its loops take.
#pragma once

#include <functional>
#include <vector>

#include "interpreter/program/program.hpp"
#include "tools/slave/slave.hpp"

namespace s7200::tools {

/// What the program is asked, and where it keeps that in V memory.
struct Command {
  static constexpr std::uint32_t kLoop = 20, kOuter = 22, kInner = 24;
  static constexpr std::uint8_t kNoLoop = 255;

  std::uint8_t loop = kNoLoop;
  std::uint16_t outer = 1, inner = 0;
};

/// Its answer.
struct Measured {
  std::uint16_t milliseconds = 0;
  std::uint8_t identification = 0;  ///< SMB6
  std::uint8_t version = 0, loops = 0;
};

/// How many loops the program has.
std::size_t measured_loops(const Program& program);

/// What a loop took for one repetition, and by how much that may be wrong.
struct LoopTime {
  double ns = 0, within = 0;
};

struct Measurement {
  std::uint8_t identification = 0;
  std::vector<LoopTime> loops;  ///< by their numbers
};

/// Asks for all loops, each for about so long. `progress` hears how many are done. Throws SlaveUnreachable, and
/// std::runtime_error if what answers is not the program, or another version of it, or does not answer.
Measurement measure_loops(Slave& slave, std::size_t loops, Time each, const std::function<void(std::size_t)>& progress);

}  // namespace s7200::tools
