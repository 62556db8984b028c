// Checks a program: its errors, its warnings, and the program itself if it can run.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "interpreter/analysis/waiter.hpp"
#include "interpreter/program/checking/checker.hpp"

namespace s7200 {

struct CheckResult {
  std::shared_ptr<const Program> program;  ///< null if there are errors
  stl::Source source;
  stl::Diagnostics diagnostics;  ///< errors and warnings, including the parser's, in order of place
};

/// decode_program() and the warnings about the whole program. `times` may be a corrected table. If `waiter` asks to end,
/// the warnings that were found by then.
CheckResult check(stl::ParseResult parsed, const CpuModel& model, const TimeTable& times, const Waiter& waiter = {});

/// Reads and checks a program text in memory: a listing or a block export.
CheckResult check_text(std::string_view utf8, const std::string& name, const CpuModel& model, const TimeTable& times);

}  // namespace s7200
