// Which CPU a program is for where nobody has named one.
#pragma once

#include "interpreter/model/cpu_model.hpp"
#include "interpreter/stl/parser.hpp"

namespace s7200 {

/// The CPU that the head of a program names, in a comment before its first instruction or in the title of its main block:
/// `// CPU 224`, `// PLC type: CPU 224XP`, or a title line with `for the CPU 224`. Null if it names none.
const CpuModel* cpu_in_head(const stl::Source& source);

/// The first CPU on which check() finds no errors: the CPU 214 if it can run the program, else the common CPUs 224, 226 and
/// 224XP, then the others. If none can, the program has mistakes: the CPU 214 all the same, unless one of the common CPUs finds
/// at most half as many.
const CpuModel& first_cpu_for(const stl::ParseResult& parsed);

}  // namespace s7200
