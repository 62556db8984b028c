#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "interpreter/base/text.hpp"
#include "tools/command/commands.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/options/program_options.hpp"
#include "tools/command/terminal.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

struct TimesOptions {
  CpuOptions cpu;
  bool csv = false, json = false;
};

void print_table(const CpuModel& model, const TimeTable& times) {
  fmt::print(
      "Execution times of CPU {} in microseconds. Only a figure marked 'manual' was read in a manual.\n"
      "To correct them: s7200 times --csv > my_times.csv, edit, and give --times my_times.csv to any verb.\n\n"
      "{:<40} {:<28} {:>9} {:>9}  {:<10} {:<11} {}\n",
      model.name, "instructions", "form", "base", "per unit", "unit", "marker", "source");
  for (const TimeRow& row : times.rows())
    fmt::print("{:<40} {:<28} {:>9} {:>9}  {:<10} {:<11} {}\n",
               stl::printable(fmt::format("{}", fmt::join(row.mnemonics, " "))), stl::printable(row.form),
               in_microseconds(row.base), row.per_unit ? in_microseconds(row.per_unit) : "", stl::printable(row.unit),
               row.marker, stl::printable(row.source));
}

nlohmann::ordered_json to_json(const CpuModel& model, const TimeTable& times) {
  auto results = results_of("times");
  results["cpu"] = model.name;
  auto& rows = results["times"] = nlohmann::ordered_json::array();
  for (const TimeRow& row : times.rows())
    rows.push_back({{"mnemonics", row.mnemonics},
                    {"form", row.form},
                    {"base_us", static_cast<double>(row.base) / kMicrosecond},
                    {"per_unit_us", static_cast<double>(row.per_unit) / kMicrosecond},
                    {"unit", row.unit},
                    {"marker", row.marker},
                    {"source", row.source}});
  return results;
}

int run_times(const TimesOptions& options) {
  const CpuModel* model = options.cpu.model();
  if (!model) return kUnusable;
  const auto times = options.cpu.times(*model);
  if (!times) return kUnusable;
  if (options.json)
    fmt::print("{}", lines_of(to_json(*model, *times)));
  else if (options.csv)
    print_file(to_csv(*times));
  else
    print_table(*model, *times);
  return kFine;
}

}  // namespace

void add_times(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<TimesOptions>();
  CLI::App* verb = app.add_subcommand("times", "the execution times in use, each with where it comes from");
  options->cpu.add_to(*verb);
  auto* csv = verb->add_flag("--csv", options->csv, "print as CSV, the form --times reads");
  verb->add_flag("--json", options->json, "print as JSON")->excludes(csv);
  verb->footer("Example: s7200 times --csv > my_times.csv");
  verb->callback([options, &exit_code] { exit_code = run_times(*options); });
}

}  // namespace s7200::tools
