// AST + instruction table + CPU model -> Program, or everything that is wrong with it.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "interpreter/base/diagnostic.hpp"
#include "interpreter/program/program.hpp"
#include "interpreter/stl/parser.hpp"

namespace s7200 {

struct CheckResult {
  std::shared_ptr<const Program> program;  ///< null if there are errors
  stl::Source source;
  stl::Diagnostics diagnostics;  ///< errors and warnings, including the parser's, in order of place
};

/// Checks mnemonics, operands (count, kind, width, range on that CPU), routines, labels, loops, where instructions are
/// allowed, and the logic stack; then decodes. `times` may be a corrected table.
CheckResult check(stl::ParseResult parsed, const CpuModel& model, const TimeTable& times);

/// The CPUs on which check() finds no errors. Each is given up at the first one.
std::vector<const CpuModel*> cpus_without_errors(stl::ParseResult parsed);

/// The first of `tried` on which check() finds no errors; null if there is none.
const CpuModel* first_cpu_without_errors(stl::ParseResult parsed, std::span<const CpuModel* const> tried);

/// The model's own table of times.
TimeTable default_times(const CpuModel& model);

}  // namespace s7200
