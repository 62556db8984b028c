// Interpreter and reference model side by side, compared after each instruction of an observed CPU,
// and after a few at once where nobody looks: that is the fast loop.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace s7200::reference {

struct LockstepResult {
  std::uint64_t instructions = 0;  ///< executed and compared
  std::uint64_t programs = 0;
  std::map<std::string, std::uint64_t> executed;  ///< with power flow where they need it, without error
  std::map<std::string, std::uint64_t> met;       ///< states and values that are rare
  std::optional<std::string> difference;          ///< the first: program, instruction, both states, seed
};

/// Runs random programs on a CPU 214 or 224 until this many instructions have been compared or a difference is found.
/// Program `i` of a run is made from `seed + i`: a run with the reported seed and one instruction shows it again.
LockstepResult run_lockstep(std::uint64_t seed, std::uint64_t instructions, const std::string& cpu = "214");

}  // namespace s7200::reference
