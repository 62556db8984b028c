// An executed instruction in words, with what the program says about it.
#pragma once

#include <cstdint>
#include <string>

#include "interpreter/program/program.hpp"
#include "interpreter/trace/trace.hpp"

namespace s7200::tools {

/// `  // of the line  [Q0.0 Pump // contactor]`: its comment, and the symbols of its addresses.
std::string remark_on(std::uint32_t op, const Program& program);

/// `line 42    =       Q0.0   S0=1 Q0.0=1  // of the line  [Q0.0 Pump // contactor]`
std::string execution_text(const InstructionRecord& record, const Program& program);

}  // namespace s7200::tools
