#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <vector>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/program/checking/warnings.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/options/choices.hpp"
#include "tools/command/options/plc/program_options.hpp"
#include "tools/command/options/plc/stand_in_options.hpp"
#include "tools/command/options/plc/tables_by_cpu.hpp"
#include "tools/command/reading/unread_symbols.hpp"
#include "tools/command/terminal/progress.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/command/verbs/commands.hpp"
#include "tools/host/interruption.hpp"
#include "tools/views/program/check_report.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

struct CheckOptions {
  CpuOptions cpu;
  std::vector<std::string> paths;
  std::vector<std::string> unwanted;  // names of warnings
  bool json = false, no_warnings = false;
};

/// Without the warnings that are switched off.
CheckResult check_with(const CheckOptions& options, const SourceText& text, const CpuModel& model, const TimeTable& times) {
  CountedProgress progress("step");
  CheckResult result = check(text.parsed, model, times, waiting_with(progress));
  if (options.cpu.no_stand_ins) refuse_stand_ins(result);
  std::erase_if(result.diagnostics, [&](const stl::Diagnostic& d) {
    return d.severity == stl::Severity::Warning &&
           (options.no_warnings || std::ranges::find(options.unwanted, d.name) != options.unwanted.end());
  });
  return result;
}

int run_check(const CheckOptions& options) {
  if (!options.cpu.model()) return kUnusable;
  catch_interruption();  // what has been checked by then is still said
  int exit_code = kFine;
  TablesByCpu tables(options.cpu);
  nlohmann::ordered_json files = nlohmann::ordered_json::array();
  auto programs = read_programs(options.paths, exit_code);
  const bool all_read = exit_code == kFine;
  for (auto& [path, text] : programs) {
    if (interrupted()) break;
    const CpuModel* model = repair(text, options.cpu.repairs) ? options.cpu.model_for(text, path) : nullptr;
    const TimeTable* times = model ? tables.of(*model) : nullptr;
    if (!times) {
      exit_code = kUnusable;
      continue;
    }
    const CheckResult result = check_with(options, text, *model, *times);
    if (!all_read && note_unread_symbols(path, result)) continue;
    if (!result.program) exit_code = std::max<int>(exit_code, kCheckFailed);
    const auto others = options.cpu.no_stand_ins ? std::vector<const CpuModel*>{} : fine_for(text, result, *model);
    if (options.json) {
      files.push_back(check_json(path, text, result, *model, others));
    } else {
      print_diagnostics(result.diagnostics, result.source);
      print_notes(reading_notes(text));
      if (result.program) accept_stand_ins(*result.program, options.cpu.no_stand_ins);
      if (!options.cpu.no_stand_ins) print_note_if_any(dropped_networks_note(result, others));
      fmt::print("{}", check_summary(text, result, *model, others));
      std::fflush(stdout);  // it stays, if the next file is interrupted
    }
  }
  if (options.json) {
    auto results = results_of("check");
    results["files"] = std::move(files);
    fmt::print("{}", lines_of(results));
  }
  print_interruption();
  return interrupted() ? kCheckFailed : exit_code;
}

}  // namespace

void add_check(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* verb = app.add_subcommand("check", "check STL programs: every error with its place and what to do about it");
  verb->add_option("PROGRAM", options->paths,
                   "STL files or published documents, with symbol tables and data blocks for all; - is standard input")
      ->required();
  options->cpu.add_cpu_and_times_to(*verb, fmt::format("CPU that they are to run on {}", kCpuFound));
  add_repair_option(*verb, options->cpu.repairs);
  add_no_stand_ins_option(*verb, options->cpu.no_stand_ins);
  std::vector<std::string> warnings;
  for (const WarningInfo& warning : all_warnings()) warnings.emplace_back(warning.name);
  offer(verb->add_option("--no-warn", options->unwanted, "leave out a warning: s7200 help warnings (repeatable)"), warnings)
      ->check([](const std::string& name) {
        return std::ranges::find(all_warnings(), name, &WarningInfo::name) != all_warnings().end()
                   ? std::string()
                   : fmt::format("there is no warning '{}'; 's7200 help warnings' lists them", stl::shortened(name));
      })
      ->allow_extra_args(false)
      ->type_name("NAME");
  verb->add_flag("--no-warnings", options->no_warnings, "leave out all warnings");
  verb->add_flag("--json", options->json, "print the results as JSON");
  verb->footer(
      "Topics: models, programs, times, warnings\n"
      "Example: s7200 check stl_programs/modbus_slave.stl");
  verb->callback([options, &exit_code] { exit_code = run_check(*options); });
}

}  // namespace s7200::tools
