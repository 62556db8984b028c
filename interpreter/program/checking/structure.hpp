// The structure of a program: main program and routines, labels, loops, calls, and where instructions are allowed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "interpreter/base/diagnostic.hpp"
#include "interpreter/program/program.hpp"

namespace s7200 {

/// A statement whose mnemonic is known.
struct CheckedStatement {
  const stl::Statement* statement;
  const Instruction* instruction;
  bool operands_good;
  bool begins_network;  ///< a NETWORK head comes directly before it
};

/// The structure as decoding needs it. Each vector has an entry for each statement, 0 where there is nothing to say.
struct ProgramStructure {
  std::vector<std::uint32_t> target;  ///< of JMP, CALL, FOR (after its NEXT), NEXT (first of its loop)
  std::vector<std::uint32_t> head;    ///< of NEXT: its FOR; of SCRT: the enclosing LSCR
  std::vector<bool> in_segment;       ///< between LSCR and SCRE
  std::array<std::uint32_t, 128> subroutine{};
  std::array<std::uint32_t, 128> interrupt{};
};

/// Adds what is wrong to `diagnostics`; the result is useful only if nothing is. `text`: the lines of the source; a routine
/// whose heading may be one that could not be read is not missing.
ProgramStructure check_structure(const std::vector<CheckedStatement>& statements, const std::vector<std::string>& text,
                                 const CpuModel& model, stl::Diagnostics& diagnostics);

/// Follows the depth of the logic stack through each network and its rungs. A rung begins at a NETWORK head, a routine head,
/// a label or loop, and at an LD after a coil or box.
void check_logic_stack(const std::vector<CheckedStatement>& statements, stl::Diagnostics& diagnostics);

}  // namespace s7200
