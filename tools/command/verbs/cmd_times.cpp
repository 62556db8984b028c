#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "interpreter/model/times/times_file.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/options/number_option.hpp"
#include "tools/command/options/plc/program_options.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/command/timing/statements_output.hpp"
#include "tools/command/verbs/commands.hpp"
#include "tools/views/program/times_text.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

struct TimesOptions {
  CpuOptions cpu;
  std::vector<std::string> tables;
  std::string checked, tip41;  ///< --check
  std::size_t band_table = 0;  ///< counted from 1 on; 0: none
  std::uint32_t band_seed = 1;
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
    fmt::print("{}", side_by_side_text(model, *tables, output_width()));
  }
  return kFine;
}

/// The table in use, or a random one around those of the CPU, with what is to be said of it. Nothing after messages.
std::optional<TimesBand::Named> table_to_show(const TimesOptions& options, const CpuModel& model) {
  if (options.band_table > 0) {
    const auto band = options.cpu.band(model, {options.band_table, options.band_seed});
    return band ? std::optional(band->last()) : std::nullopt;
  }
  const auto times = options.cpu.times(model);
  return times ? std::optional(TimesBand::Named{"", *times}) : std::nullopt;
}

int show_table(const TimesOptions& options, const CpuModel& model) {
  const auto shown = table_to_show(options, model);
  if (!shown) return kUnusable;
  const auto& [about, times] = *shown;
  if (options.json) {
    auto results = results_of("times");
    results["cpu"] = model.name;
    results["tables"] = tables_json(model);
    if (!about.empty()) results["about"] = about;
    results["times"] = table_json(times);
    fmt::print("{}", lines_of(results));
  } else if (options.csv) {
    print_file(cpu_line(model.name) + comment_line(about) + to_csv(times));
  } else {
    if (!about.empty()) print_report(about + "\n\n");
    fmt::print("{}\n", table_text(model, times, output_width()));
    print_report(tables_text(model));
  }
  return kFine;
}

std::string refuse_no_name(const std::string& table) { return table.empty() ? "a table has a name, or is a file" : ""; }

int run_times(const TimesOptions& options) {
  const CpuModel* model = options.cpu.model();
  if (!model) return kUnusable;
  if (!options.checked.empty()) return check_table(*model, options.checked, options.tip41, options.json);
  return options.tables.empty() ? show_table(options, *model) : show_side_by_side(options, *model);
}

}  // namespace

void add_times(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<TimesOptions>();
  CLI::App* verb = app.add_subcommand("times", "the execution times in use, each with where it comes from");
  auto* tables = verb->add_option("TABLE", options->tables, "names of tables, or CSV files, to show side by side");
  tables->check(refuse_no_name);
  options->cpu.add_cpu_and_times_to(*verb, "CPU whose times these are [214]");
  auto* check = verb->add_option("--check", options->checked, "check a table against what is known of real CPUs")
                    ->check(refuse_no_name)
                    ->type_name("TABLE");
  verb->add_option("--tip41", options->tip41, "with --check: the document of Application Tip 41, for what it says of itself")
      ->type_name("FILE")
      ->needs(check);
  auto* random = add_whole_number(*verb, "--band-table", options->band_table, {1, 100'000},
                                  "show this random table of --times-band, by the number that send, master or test name")
                     ->excludes(tables);
  add_whole_number(*verb, "--band-seed", options->band_seed, {0, UINT32_MAX}, "seed of the random table", "1")
      ->needs(random);
  for (CLI::Option* other : {tables, verb->get_option("--times"), random}) check->excludes(other);
  verb->get_option("--times")->excludes(tables);
  auto* csv =
      verb->add_flag("--csv", options->csv, "print as CSV, the form --times reads")->excludes(tables)->excludes(check);
  verb->add_flag("--json", options->json, "print as JSON")->excludes(csv);
  verb->footer(
      "Exit code 1 if a statement of --check does not hold.\n"
      "Topics: times\n"
      "Example: s7200 times --cpu 224 --csv > my_times.csv\n"
      "Example: s7200 times cpu214 cpu214_from_22x my_times.csv\n"
      "Example: s7200 times --check cpu214_from_22x --tip41 tip41.txt");
  verb->callback([options, &exit_code] { exit_code = run_times(*options); });
}

}  // namespace s7200::tools
