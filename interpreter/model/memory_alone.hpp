// Which instructions work on memory alone. The table answers (instructions/table.cpp), group by group.
#pragma once

#include "interpreter/model/instruction.hpp"

namespace s7200 {

/// Whether what an instruction does depends on memory, the logic stack, the power rail and ENO alone, and it changes nothing
/// else but where the program goes on; a CALL and a return also work on the levels of calls. Timers and counters do not
/// count as memory. A run-time error is something else that changes.
bool works_on_memory_alone(const Instruction& instruction);

}  // namespace s7200
