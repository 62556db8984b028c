// The requests of a programming device to a CPU, besides reading and writing memory.
#pragma once

#include "interpreter/cpu/cpu.hpp"

namespace s7200::tools {

/// RUN or STOP, now. After a fatal error the CPU must not be asked.
void change_mode(Cpu& cpu, Mode mode);

}  // namespace s7200::tools
