#include "interpreter/analysis/warnings/check.hpp"

#include <utility>

#include "interpreter/analysis/effects/looks.hpp"
#include "interpreter/analysis/warnings/find_warnings.hpp"
#include "interpreter/program/load.hpp"
#include "interpreter/program/loading/stand_ins.hpp"
#include "interpreter/stl/tables/project.hpp"

namespace s7200 {
namespace {

/// A program need not use all of a stand-in.
void forget_warnings_of_stand_ins(const stl::Source& source, stl::Diagnostics& diagnostics) {
  std::erase_if(diagnostics, [&](const stl::Diagnostic& d) {
    return d.severity == stl::Severity::Warning && is_stand_in(stl::in_file(source, d.position.line).file);
  });
}

}  // namespace

CheckResult check(stl::ParseResult parsed, const CpuModel& model, const TimeTable& times, const Waiter& waiter) {
  DecodedSource decoded = decode_program(std::move(parsed), model, times);
  if (decoded.known) find_warnings(*decoded.known, decoded.diagnostics, waiter);
  if (decoded.program) decoded.program->looks = looks_of(*decoded.program);
  forget_warnings_of_stand_ins(decoded.source, decoded.diagnostics);
  stl::sort(decoded.diagnostics);
  return {std::move(decoded.program), std::move(decoded.source), std::move(decoded.diagnostics)};
}

CheckResult check_text(std::string_view utf8, const std::string& name, const CpuModel& model, const TimeTable& times) {
  return check(read_text(utf8, name), model, times);
}

}  // namespace s7200
