#include "tools/command/inspecting/inspected_program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "interpreter/analysis/effects/looks.hpp"
#include "interpreter/program/checking/checker.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/options/plc/stand_in_options.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/measuring/seen_times.hpp"
#include "tools/measuring/worst_instant.hpp"

namespace s7200::tools {
namespace {

/// What is known of a program; null after a message if that is nothing. Errors are said, and what they are in is left out.
std::shared_ptr<const Program> decoded(const CpuOptions& options, const SourceText& text, const CpuModel& model,
                                       const TimeTable& times, int& exit_code) {
  DecodedSource source = decode_program(text.parsed, model, times);
  std::erase_if(source.diagnostics, [](const auto& d) { return d.severity == stl::Severity::Warning; });
  stl::sort(source.diagnostics);
  print_diagnostics(source.diagnostics, source.source);
  print_notes(reading_notes(text));
  if (source.program && !accept_stand_ins(*source.program, options.no_stand_ins)) {
    exit_code = std::max<int>(exit_code, kCheckFailed);
    return nullptr;
  }
  if (source.program) {
    source.program->looks = looks_of(*source.program);
    return source.program;
  }
  exit_code = std::max<int>(exit_code, kCheckFailed);
  if (source.known)
    print_note(fmt::format("{} has errors: what they are in is left out", source.source.name));
  else
    print_error(fmt::format("{} has errors after which too little is known of it", source.source.name));
  return source.known;
}

}  // namespace

std::shared_ptr<const Program> known_program(const CpuOptions& options, ProgramFiles& file, TablesByCpu& tables,
                                             int& exit_code) {
  const bool repaired = repair(file.text, options.repairs);
  const CpuModel* model = repaired ? options.model_for(file.text, file.path) : nullptr;
  const TimeTable* times = model ? tables.of(*model) : nullptr;
  if (!times) return exit_code = kUnusable, nullptr;
  return decoded(options, file.text, *model, *times, exit_code);
}

std::optional<Inspection> inspected(const CpuOptions& options, ProgramFiles& file, const Question& question,
                                    TablesByCpu& tables, const Waiter& waiter, int& exit_code) {
  int errors = kFine;
  auto program = known_program(options, file, tables, errors);
  exit_code = std::max(exit_code, errors);
  if (!program) return {};
  const CpuModel* const model = program->model;
  const TimeTable* const times = tables.of(*model);
  std::optional<Inspection> inspection(std::in_place, std::move(program), waiter);
  inspection->has_errors = errors != kFine;
  inspection->lose_word = worst_instant;
  inspection->see_times = seen_times;
  inspection->slowest = [&file, model, times] { return decode_program(file.text.parsed, *model, slowest(*times)).known; };
  auto selection = parse_selection(question.about, inspection->facts);
  if (selection && !question.view.of_memory && !selection->memory.empty())
    selection = trouble("'{}': {} keeps to routines and networks, not to addresses", selection->memory.front().text,
                        question.view.name);
  if (!selection) {
    print_error(fmt::format("{}: {}", file.path, selection.why()));
    return exit_code = kUnusable, std::nullopt;
  }
  inspection->selection = std::move(*selection);
  return inspection;
}

}  // namespace s7200::tools
