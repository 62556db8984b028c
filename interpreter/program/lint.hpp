// Warnings that need the whole program. Each function finds one of the table in warnings.hpp, in a program without errors.
//
// A warning that is wrong is worse than none. So two coils, or two executions of a timer, are reported only where no pass
// through the program does one without the other; what JMP, CRET, END, FOR or a conditional CALL may leave out is not.
#pragma once

#include "interpreter/program/program.hpp"
#include "interpreter/base/diagnostic.hpp"

namespace s7200 {

/// A coil that always writes again what an earlier one has written. An inactive segment writes its coils too, so LSCR does
/// not keep them apart. Memory that is read in between may be used twice; an output may not, the last coil decides.
void find_double_coils(const Program& program, stl::Diagnostics& diagnostics);

/// A timer or counter has one current value: executed twice in a scan it counts twice, or is reset by the other rung.
void find_double_timers(const Program& program, stl::Diagnostics& diagnostics);
void find_double_counters(const Program& program, stl::Diagnostics& diagnostics);

/// Interrupts are disabled when the CPU enters RUN (facts 3.3).
void find_missing_eni(const Program& program, stl::Diagnostics& diagnostics);

/// SMB30 is 0 when the CPU enters RUN: the port speaks PPI.
void find_missing_freeport(const Program& program, stl::Diagnostics& diagnostics);

/// Bits set by S, = or SCRT. Whoever reads S memory by bytes, words or pointers is taken to load all that lies there.
void find_unused_steps(const Program& program, stl::Diagnostics& diagnostics);

}  // namespace s7200
