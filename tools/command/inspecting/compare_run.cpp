#include "tools/command/inspecting/compare_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "tools/command/exit_code.hpp"
#include "tools/command/inspecting/inspected_program.hpp"
#include "tools/command/options/plc/tables_by_cpu.hpp"
#include "tools/command/terminal/progress.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/command/testing/trial_output.hpp"
#include "tools/compare/behaviour.hpp"
#include "tools/compare/structure.hpp"
#include "tools/host/interruption.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

nlohmann::ordered_json side_json(const ProgramFiles& files, const Program& program) {
  return {{"file", files.path}, {"cpu", program.model->name}};
}

/// Runs both programs, if that can say more than how they are written. Nothing after a note if they cannot be run.
std::optional<BehaviourResult> behaviour(const CompareOptions& options, const Inspection& older, const Inspection& newer,
                                         const std::vector<MemoryRange>& watched) {
  if (options.structure_alone) return {};
  BehaviourSettings settings{.seed = options.bound.seed, .runs = options.bound.runs, .seconds = options.bound.seconds};
  settings.watched = watched;
  settings.stop = interruption();
  CountedProgress progress("run");
  settings.progress = [&](std::uint64_t runs) { progress(runs); };
  return compare_behaviour(older, newer, settings);
}

/// Nothing, after a message, if a word is no address.
std::optional<std::vector<MemoryRange>> watched_memory(const CompareOptions& options, const Inspection& older) {
  std::vector<MemoryRange> all;
  for (const std::string& word : options.watched) {
    const auto range = parse_range(word, *older.program);
    if (!range) return print_error(fmt::format("--watch: {}", range.why())), std::nullopt;
    all.push_back(*range);
  }
  return all;
}

/// Writes the scenario of a difference.
ExitCode write_scenario(const CompareOptions& options, const OldAndNew& files, const Inspection& older,
                        const Inspection& newer, const std::optional<BehaviourResult>& result, const TrialFile& file) {
  if (options.write.empty()) return kFine;
  if (!result || !result->difference) return print_note("--write: no difference of behaviour, nothing is written"), kFine;
  const ScenarioOrigin origin = scenario_origin(options.write, files.older.path, files.old_parts, options.cpu);
  const auto text = difference_scenario(older, newer, *result, options.write, origin);
  if (!text) return print_note(fmt::format("--write: nothing is written: {}", text.why())), kFine;
  return file.write(*text) ? kFine : kUnusable;
}

}  // namespace

int run_compare(const CompareOptions& options) {
  auto files = read_compared(options.files);
  if (!files || !options.cpu.model()) return kUnusable;
  TablesByCpu tables(options.cpu);
  int exit_code = kFine;
  const auto old_program = known_program(options.cpu, files->older, tables, exit_code);
  const auto new_program = known_program(options.cpu, files->newer, tables, exit_code);
  if (!old_program || !new_program) return exit_code;
  const Inspection older(old_program), newer(new_program);
  const auto watched = watched_memory(options, older);
  TrialFile file;
  if (!watched || !file.claim("--write", options.write, "compare", options.files.all())) return kUnusable;
  catch_interruption();
  const StructureDifference structure = structure_difference(older, newer);
  const bool same = structure.same_for_the_cpu();
  if (!options.json) fmt::print("{}", structure_text(older, newer, structure));
  std::fflush(stdout);
  const bool has_errors = exit_code != kFine;
  if (has_errors) print_note("programs with errors are not run: only how they are written is compared");
  const auto result = same || has_errors ? std::nullopt : behaviour(options, older, newer, *watched);
  if (options.json) {
    auto results = results_of("compare");
    results["old"] = side_json(files->older, *old_program);
    results["new"] = side_json(files->newer, *new_program);
    results["same"] = same;
    results["structure"] = structure_json(older, newer, structure);
    results["behaviour"] = result ? behaviour_json(older, newer, *result) : nlohmann::ordered_json();
    fmt::print("{}", lines_of(results));
  } else if (result) {
    fmt::print("{}", behaviour_text(older, newer, *result));
  }
  exit_code = std::max<int>(exit_code, write_scenario(options, *files, older, newer, result, file));
  print_interruption();
  return same ? exit_code : std::max<int>(exit_code, kCheckFailed);
}

}  // namespace s7200::tools
