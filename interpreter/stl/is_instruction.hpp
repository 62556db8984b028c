// What this room is told of instructions, of which it has no table.
#pragma once

#include <cstddef>
#include <functional>
#include <string_view>

namespace s7200::stl {

/// Whether a mnemonic in capitals with so many operands is an instruction. Empty where nobody knows.
using IsInstruction = std::function<bool(std::string_view mnemonic, std::size_t operands)>;

/// Whether it is one with any number of operands, from `fewest` on.
inline bool is_mnemonic(const IsInstruction& is_instruction, std::string_view mnemonic, std::size_t fewest = 0) {
  constexpr std::size_t kMostOperands = 8;
  for (std::size_t operands = fewest; operands <= kMostOperands; ++operands)
    if (is_instruction(mnemonic, operands)) return true;
  return false;
}

}  // namespace s7200::stl
