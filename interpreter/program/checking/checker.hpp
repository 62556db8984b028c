// AST + instruction table + CPU model -> Program, or the errors in it. The warnings about a whole program, which check()
// adds, are found in interpreter/analysis/.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "interpreter/base/diagnostic.hpp"
#include "interpreter/program/program.hpp"
#include "interpreter/stl/parser.hpp"

namespace s7200 {

struct DecodedSource {
  std::shared_ptr<Program> program;  ///< null if there are errors; its `looks` are not known yet
  /// The program, or what is known of one with errors, for the search for warnings; null if too little is known.
  std::shared_ptr<const Program> known;
  stl::Source source;
  stl::Diagnostics diagnostics;  ///< errors, and warnings about single statements; including the parser's, in no order
};

/// Checks mnemonics, operands (count, kind, width, range on that CPU), routines, labels, loops, where instructions are
/// allowed, and the logic stack; then decodes. `times` may be a corrected table.
DecodedSource decode_program(stl::ParseResult parsed, const CpuModel& model, const TimeTable& times);

/// The CPUs on which decode_program() finds no errors. Each is given up at the first one.
std::vector<const CpuModel*> cpus_without_errors(stl::ParseResult parsed);

/// The first of `tried` on which decode_program() finds no errors; null if there is none.
const CpuModel* first_cpu_without_errors(stl::ParseResult parsed, std::span<const CpuModel* const> tried);

/// The model's own table of times.
TimeTable default_times(const CpuModel& model);

}  // namespace s7200
