#include "tools/command/testing/fuzz_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>

#include "interpreter/base/file_path.hpp"
#include "interpreter/base/result.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/inspecting/inspected_program.hpp"
#include "tools/command/options/plc/tables_by_cpu.hpp"
#include "tools/command/terminal/progress.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/command/testing/trial_output.hpp"
#include "tools/fuzzing/fuzz.hpp"
#include "tools/host/files/file_system.hpp"
#include "tools/host/interruption.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

/// `VB0..VB999`, `VB0:1000`. Trouble if it is no V memory.
Result<MemoryRange> written_range(const std::string& text, const Program& program) {
  const auto dots = text.find("..");
  auto range = parse_range(text.substr(0, dots), program);
  if (!range) return range.trouble();
  if (dots != std::string::npos) {
    const auto last = parse_range(text.substr(dots + 2), program);
    if (!last) return last.trouble();
    if (last->area != range->area || last->at < range->at)
      return trouble("'{}' has its last address before the first", text);
    *range = {.area = range->area,
              .width = Width::Byte,
              .number = range->number,
              .count = last->at + last->bytes() - range->at,
              .at = range->at};
  }
  if (range->area == Area::V) return range;
  return trouble("'{}' is not in V memory", text);
}

/// Nothing after a message.
std::optional<FuzzSettings> settings_of(const FuzzOptions& options, const Program& program) {
  FuzzSettings settings{.seed = options.bound.seed, .runs = options.bound.runs, .seconds = options.bound.seconds};
  settings.answers_within = options.answers_within;
  for (const std::string& text : options.writes) {
    const auto range = written_range(text, program);
    if (!range) return print_error(fmt::format("--writes: {}", range.why())), std::nullopt;
    settings.writes.push_back(*range);
  }
  for (const std::string& text : options.never) {
    auto rule = Expression::parse(text, program);
    if (rule && rule->places().empty()) rule = trouble("'{}' has no address, so it always holds or never does", text);
    if (!rule) return print_error(fmt::format("--never: {}", rule.why())), std::nullopt;
    settings.never.push_back(std::move(*rule));
  }
  settings.stop = interruption();
  return settings;
}

/// A scenario for each finding, `finding_1.yaml` …
ExitCode write_scenarios(const FuzzOptions& options, const Inspection& inspection, const FuzzResult& result,
                         const std::string& program, const std::vector<std::string>& parts) {
  if (options.folder.empty()) return kFine;
  const std::filesystem::path folder = file_path(options.folder);
  std::error_code error;
  std::filesystem::create_directory(folder, error);
  if (!std::filesystem::is_directory(folder)) {
    print_error(fmt::format("--write: cannot make the folder {}: {}", options.folder, error_text(error)));
    return kUnusable;
  }
  for (std::size_t i = 0; i < result.findings.size(); ++i) {
    const std::string path = (folder / fmt::format("finding_{}.yaml", i + 1)).string();
    const ScenarioOrigin origin = scenario_origin(path, program, parts, options.cpu);
    const auto text = finding_scenario(inspection, result, result.findings[i], path, origin);
    TrialFile file;
    if (!text)
      print_note(fmt::format("finding {} is not written: {}", i + 1, text.why()));
    else if (!file.claim("--write", path, "fuzz", options.files) || !file.write(*text))
      return kUnusable;
  }
  return kFine;
}

}  // namespace

int run_fuzz(const FuzzOptions& options) {
  if (!options.cpu.model()) return kUnusable;
  int exit_code = kFine;
  auto programs = read_programs(options.files, exit_code);
  if (exit_code != kFine) return exit_code;
  if (programs.size() != 1) return print_error("fuzz takes one program, and the other files of its project"), kUnusable;
  TablesByCpu tables(options.cpu);
  const auto program = known_program(options.cpu, programs.front(), tables, exit_code);
  if (!program) return exit_code;
  if (exit_code != kFine) return print_error("a program with errors cannot be run"), exit_code;
  catch_interruption();
  auto settings = settings_of(options, *program);
  if (!settings) return kUnusable;
  CountedProgress progress("run");
  settings->progress = [&](std::uint64_t runs) { progress(runs); };
  const Inspection inspection(program, {settings->stop});
  const FuzzResult result = fuzz(inspection, *settings);
  progress.end();
  if (options.json) {
    auto json = results_of("fuzz");
    json["file"] = programs.front().path;
    json["cpu"] = program->model->name;
    json.update(fuzz_json(inspection, result));
    fmt::print("{}", lines_of(json));
  } else {
    fmt::print("{}", fuzz_text(inspection, result));
  }
  std::fflush(stdout);
  std::vector<std::string> parts;
  std::ranges::copy_if(options.files, std::back_inserter(parts),
                       [&](const std::string& path) { return path != programs.front().path; });
  const ExitCode written = write_scenarios(options, inspection, result, programs.front().path, parts);
  print_interruption();
  return std::max<int>({written, result.findings.empty() ? kFine : kCheckFailed, interrupted() ? kCheckFailed : kFine});
}

}  // namespace s7200::tools
