// The instruction table in words: one instruction explained, and the reference page.
#pragma once

#include <string>

#include "interpreter/model/instruction.hpp"
#include "interpreter/model/times/times.hpp"

namespace s7200::tools {

/// A time in microseconds: `73`, or `33 + 3/bit`.
std::string time_text(const TimeRow& row);

/// The line of the table of times for plain operands; for bits, V memory stands for the slower areas. Null without one.
const TimeRow* typical_time(const TimeTable& times, const Instruction& instruction);

/// The flags that an instruction sets: `SM1.0 SM1.1`, or `none`.
std::string flags_text(const Instruction& instruction);

/// The parts of a program in which an instruction may stand: `main program, subroutines`, or `anywhere`.
std::string parts_text(const Instruction& instruction);

/// The operands that a rule permits, by the letters of STL: `VW T C IW … constant *VD *AC`.
std::string operand_text(const OperandRule& rule);

/// A statement that is right on the smallest CPU that has the instruction: `MOVW VW100, VW200`.
std::string example(const Instruction& instruction);

/// Everything about one instruction: operands, ranges on each CPU, flags, times with where they come from, an example.
std::string explain(const Instruction& instruction, const TimeTable& times);

/// The whole table of instructions as a Markdown page.
std::string reference_page();

}  // namespace s7200::tools
