// A program changed in one thing at a time, as someone might change it by mistake.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "interpreter/program/program.hpp"

namespace s7200::tools {

/// A change of one thing.
struct Mutation {
  std::uint32_t op = 0;  ///< the instruction that is changed, or the first of them
  std::string what{};    ///< `LDN for LD`, `VW102 for VW101`, `deleted`
  /// What stands in the place of instructions, by op.
  std::map<std::uint32_t, std::vector<stl::Statement>> instead{};
};

/// In the order of the program; within an instruction in the order of its operands. Left out are stand-ins for libraries,
/// instructions that nothing in the program leads to, and comparisons whose operands may be swapped.
std::vector<Mutation> mutations_of(const Program& program);

/// A changed program, or why there is none.
struct Mutant {
  enum class Kind : std::uint8_t {
    Program,
    Refused,  ///< the checker finds an error in it
    Same,     ///< it is decoded to the same operations
  };
  Kind kind = Kind::Refused;
  std::shared_ptr<const Program> program{};  ///< of Program
};

/// The program with a mutation: with the same times and settings, decoded anew in memory.
Mutant mutated(const Program& program, const Mutation& mutation);

}  // namespace s7200::tools
