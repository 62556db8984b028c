// What the vectors try: for each instruction the values that matter and, for the first of them, every form its operands can
// have.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/model/instruction.hpp"
#include "tests/vectors/author.hpp"

namespace s7200::vectors {

/// Content of an operand: its elements, from the place that it names.
using Elements = std::vector<std::uint32_t>;

struct Values {
  std::vector<Elements> operand;
  Levels stack{true};
  std::string title{};
};

/// Values to try, by mnemonic; the first are the usual ones.
std::vector<Values> values_of(std::string_view mnemonic);

/// Programs of several instructions, for what a single one cannot show.
std::vector<Case> programs_of(std::string_view mnemonic);

/// All cases of an instruction on the smallest CPU of those tested that has it; on a larger one what it adds: the same
/// values in its times and with its rules, and the forms of operands that the smaller one has not.
std::vector<Case> cases_of(const Instruction& instruction, const CpuModel& model);

/// Where the rulebook describes it.
std::string source_of(const Instruction& instruction);

}  // namespace s7200::vectors
