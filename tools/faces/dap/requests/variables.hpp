// What an editor shows of a PLC that stands still: scopes with variables, and parts of variables.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/session/past/history.hpp"

namespace s7200::tools::dap {

/// A number that stands for what has variables. It stays the same as long as the program is debugged.
using Container = std::uint32_t;
inline constexpr Container kNoParts = 0;

struct Variable {
  std::string name{};
  std::string value{};
  std::string type{};
  std::string expression{};  ///< that gives it; empty: none does
  std::string memory{};      ///< where it is; empty: not in memory
  Container parts = kNoParts;
  bool settable = false;
};

struct Scope {
  std::string name{};
  Container variables = kNoParts;
  std::string memory{};
  bool registers = false;
};

/// Of the routine number `open` from the innermost; what all have in common is in each. What a port and the system have of
/// memory is special memory: theirs begins at the port's control byte, and at SMB0.
std::vector<Scope> scopes_of(const serial::Simulation& simulation, std::uint32_t open);

/// Nothing for what is not a container.
std::vector<Variable> variables_of(const serial::Simulation& simulation, const History& history, Container container);

/// A range with its value.
Variable variable_of(const Cpu& cpu, const MemoryRange& range, const std::string& name);

/// The addresses that the program names, each once, by area and place: `VW100`, `Pump:Q0.0`.
std::vector<std::string> addresses_in(const Program& program);

}  // namespace s7200::tools::dap
