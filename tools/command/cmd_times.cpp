#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "interpreter/program/load_times.hpp"
#include "tools/command/commands.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/options/program_options.hpp"
#include "tools/command/statements_output.hpp"
#include "tools/command/terminal.hpp"
#include "tools/measuring/statements.hpp"
#include "tools/views/results_json.hpp"
#include "tools/views/times_text.hpp"

namespace s7200::tools {
namespace {

struct TimesOptions {
  CpuOptions cpu;
  std::vector<std::string> tables;
  std::string checked, tip41;  ///< --check
  bool csv = false, json = false;
};

int show_side_by_side(const TimesOptions& options, const CpuModel& model) {
  const auto tables = load_all(options.tables, model);
  if (!tables) return kUnusable;
  if (options.json) {
    auto results = results_of("times");
    results["cpu"] = model.name;
    results["side_by_side"] = side_by_side_json(model, *tables);
    fmt::print("{}", lines_of(results));
  } else {
    fmt::print("{}", side_by_side_text(model, *tables));
  }
  return kFine;
}

int show_table(const TimesOptions& options, const CpuModel& model) {
  const auto times = options.cpu.times(model);
  if (!times) return kUnusable;
  if (options.json) {
    auto results = results_of("times");
    results["cpu"] = model.name;
    results["tables"] = tables_json(model);
    results["times"] = table_json(*times);
    fmt::print("{}", lines_of(results));
  } else if (options.csv) {
    print_file(to_csv(*times));
  } else {
    fmt::print("{}\n{}", table_text(model, *times), tables_text(model));
  }
  return kFine;
}

/// Nothing after a message: it cannot be read, or is another program.
std::optional<SourceText> read_tip41(const std::string& path) {
  auto text = read_program_text(path);
  if (!text || is_tip41(*text)) return text;
  print_error(fmt::format("--tip41: {} is not Application Tip 41: it has other routines", path));
  return {};
}

int check_table(const TimesOptions& options, const CpuModel& model) {
  const auto tables = load_all({options.checked}, model);
  if (!tables) return kUnusable;
  std::optional<SourceText> tip41;
  if (!options.tip41.empty() && !(tip41 = read_tip41(options.tip41))) return kUnusable;
  const auto statements = check_statements(model, tables->front().times, tip41 ? &*tip41 : nullptr);
  if (options.json) {
    auto results = results_of("times");
    results["cpu"] = model.name;
    results["statements"] = statements_json(statements);
    fmt::print("{}", lines_of(results));
  } else {
    fmt::print("{}", statements_text(model, options.checked, statements));
  }
  if (statements.empty()) print_note(fmt::format("nothing is known of the times of CPU {}", model.name));
  return any_fails(statements) ? kCheckFailed : kFine;
}

int run_times(const TimesOptions& options) {
  const CpuModel* model = options.cpu.model();
  if (!model) return kUnusable;
  if (!options.checked.empty()) return check_table(options, *model);
  return options.tables.empty() ? show_table(options, *model) : show_side_by_side(options, *model);
}

}  // namespace

void add_times(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<TimesOptions>();
  CLI::App* verb = app.add_subcommand("times", "the execution times in use, each with where it comes from");
  auto* tables = verb->add_option("TABLE", options->tables, "names of tables, or CSV files, to show side by side");
  options->cpu.add_to(*verb);
  auto* check = verb->add_option("--check", options->checked, "say which statements known from real CPUs hold with a table")
                    ->type_name("TABLE");
  verb->add_option("--tip41", options->tip41, "with --check: the document of Application Tip 41, for what it says of itself")
      ->type_name("FILE")
      ->needs(check);
  for (CLI::Option* other : {tables, verb->get_option("--times")}) check->excludes(other);
  verb->get_option("--times")->excludes(tables);
  auto* csv =
      verb->add_flag("--csv", options->csv, "print as CSV, the form --times reads")->excludes(tables)->excludes(check);
  verb->add_flag("--json", options->json, "print as JSON")->excludes(csv);
  verb->footer(
      "A figure is within so many percent: the true one lies between it / 1.25 and it × 1.25 if that says 25%.\n"
      "Example: s7200 times --csv > my_times.csv\n"
      "         s7200 times cpu214 cpu214_from_22x my_times.csv\n"
      "         s7200 times --check cpu214_from_22x --tip41 tip41.txt\n"
      "Exit code 1 if a statement of --check does not hold.");
  verb->callback([options, &exit_code] { exit_code = run_times(*options); });
}

}  // namespace s7200::tools
