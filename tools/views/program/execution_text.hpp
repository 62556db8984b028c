// An executed instruction in words, with what the program says about it.
#pragma once

#include <cstdint>
#include <string>

#include "interpreter/cpu/cpu.hpp"
#include "interpreter/program/program.hpp"
#include "interpreter/trace/trace.hpp"

namespace s7200::tools {

/// The comment of an instruction, and the symbols of its addresses: `  // of the line  [Q0.0 Pump // contactor]`
std::string remark_on(std::uint32_t op, const Program& program);

/// An executed instruction with what no record has room for.
struct Execution {
  InstructionRecord record{};
  std::string parameters{};  ///< of a CALL: those it has handed over, ` VW10=16#0005`
};

/// The execution of the instruction that the CPU has just executed.
Execution execution_of(const InstructionRecord& record, const Cpu& cpu);

/// An execution as text: `line 42    =       Q0.0   S0=1 Q0.0=1`
std::string describe(const Execution& execution, const Program& program);

/// An execution as text with the program's comment and symbols: `  // of the line  [Q0.0 Pump // contactor]`
std::string execution_text(const InstructionRecord& record, const Program& program);
std::string execution_text(const Execution& execution, const Program& program);

}  // namespace s7200::tools
