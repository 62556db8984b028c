// AST + instruction table + CPU model -> Program, or all that is wrong with it.
#pragma once

#include <memory>

#include "interpreter/program/program.hpp"
#include "interpreter/base/diagnostic.hpp"
#include "interpreter/stl/parser.hpp"

namespace s7200 {

struct CheckResult {
  std::shared_ptr<const Program> program;  ///< null when there are errors
  stl::Source source;
  stl::Diagnostics diagnostics;  ///< errors and warnings, in order of place, the parser's among them
};

/// Checks mnemonics, operands (count, kind, width, range on that CPU), routines, labels, loops, what may stand where, the
/// logic stack; then decodes. `times` may be a corrected table.
CheckResult check(stl::ParseResult parsed, const CpuModel& model, const TimeTable& times);

/// The model's own table of times.
TimeTable default_times(const CpuModel& model);

}  // namespace s7200
