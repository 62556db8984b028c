// The routines that are open: what runs, what called it, and what it interrupted.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "interpreter/cpu/state.hpp"

namespace s7200::tools {

struct OpenRoutine {
  std::uint32_t op = 0;  ///< the next instruction, of a caller its CALL
  LogicStack stack{};
  std::array<std::uint8_t, 16> accumulators{};  ///< as in the image
  bool interrupted = false;                     ///< the accumulators are those that it will find again
  std::optional<std::uint8_t> event{};          ///< of an interrupt routine: what it serves
  Time since = 0;                               ///< of an interrupt routine: when it began
};

/// The innermost first; none in STOP. An interrupt in the system's part of the scan interrupts no routine.
std::vector<OpenRoutine> open_routines(const State& state);

}  // namespace s7200::tools
