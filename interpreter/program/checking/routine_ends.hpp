// MEND, RET and RETI, which nobody writes for a CPU 22x.
#pragma once

#include "interpreter/stl/parser.hpp"

namespace s7200 {

/// Ends every routine that has no end: Micro/WIN 3.2 and 4 do so for the CPUs 22x (facts 3.5, 4.6); for a CPU 21x the ends
/// are written. An end is at the last statement of its routine.
void add_missing_ends(stl::Source& source);

/// Takes back what the reader of a document reported of routines without end, if the document writes no ends at all.
void forget_missing_ends(stl::ParseResult& parsed);

/// Does both.
void add_missing_ends(stl::ParseResult& parsed);

}  // namespace s7200
