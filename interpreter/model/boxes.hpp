// Boxes of the ladder editor whose names are written in place of mnemonics.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "interpreter/model/instruction.hpp"

namespace s7200 {

/// An instruction that does a part of a box, or all of it.
struct BoxStep {
  const Instruction* instruction = nullptr;
  std::vector<std::size_t> operands{};  ///< of the box, by their numbers, in the instruction's order
};

/// The instructions in place of a box with so many operands: MOVW 0, 2 and +I 1, 2 for ADD_I. Empty for another name, and
/// if the box has another number of operands.
std::vector<BoxStep> steps_of_box(std::string_view name, std::size_t operands);

/// The same for an instruction that works on its output and is written with the inputs and the output of its box:
/// `+I VW0, VW2, VW4`. The first step moves the first input to the output; if that is twice as wide, to its low word.
std::vector<BoxStep> steps_with_output(const Instruction& instruction, std::size_t operands);

/// What a mnemonic of the S7-200 with so many operands is elsewhere: `ORB` without operands. Empty texts for others.
UnknownMnemonic other_use(std::string_view mnemonic, std::size_t operands);

}  // namespace s7200
