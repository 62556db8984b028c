// Which CPU a program is for where nobody has named one.
#pragma once

#include <string>
#include <string_view>

#include "interpreter/model/cpu_model.hpp"
#include "interpreter/stl/parser.hpp"

namespace s7200 {

/// The CPU that the head of a program names, in a comment before its first instruction or in the title of its main block:
/// `// CPU 224`, `// PLC type: CPU 224XP`, `// CPU 224 REL 01.20`, or a title line with `for the CPU 224`. Null if it names
/// none.
const CpuModel* cpu_in_head(const stl::Source& source);

/// What the head says instead of one that is modelled: `224CN`, `313C`; empty if it names none, or one that is modelled. A
/// CPU of the CN series, for the Chinese market, is the one without CN, and both functions have it.
std::string unmodelled_cpu_in_head(const stl::Source& source);

/// Whether a line that is not a comment does nothing but name a CPU, as the head of a printed program does:
/// `CPU: 224 REL 02.01`.
bool is_cpu_line(std::string_view line);

/// The first CPU on which check() finds no errors: the CPU 214 if it can run the program, else the common CPUs 224, 226 and
/// 224XP, then the others; of a program with symbols of the SMART the CPU 226 is the first. If none can, the program has
/// mistakes: then it is the first of the common CPUs on which check() finds the fewest errors, since it is most likely
/// written for that one.
const CpuModel& first_cpu_for(const stl::ParseResult& parsed);

}  // namespace s7200
