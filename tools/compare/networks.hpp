// The networks of a program as they are compared: what the CPU gets of each instruction, and what only people read.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/views/inspection/inspection.hpp"

namespace s7200::tools {

struct ComparedNetwork {
  std::string routine;                  ///< `MAIN`, `SBR_3`
  std::uint32_t number = 0;             ///< in its routine; 0 in front of the first
  std::string title;                    ///< of its NETWORK line
  std::uint32_t first = 0, end = 0;     ///< its instructions: from the first until before `end`
  std::vector<std::string> code{};      ///< of each instruction: cpu_text()
  std::vector<std::string> comments{};  ///< in front of it, in it and at its instructions
};

/// An instruction as the CPU gets it: addresses in place of symbols, constants by their values.
std::string cpu_text(const stl::Statement& statement);

/// An instruction as people see it who have its symbols.
std::string symbolic_text(const stl::Statement& statement);

/// All networks in the order of the program. Without NETWORK lines each rung is one.
std::vector<ComparedNetwork> compared_networks(const Inspection& inspection);

}  // namespace s7200::tools
