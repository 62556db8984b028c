#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "interpreter/base/text/text.hpp"
#include "interpreter/program/load.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/options/number_option.hpp"
#include "tools/command/options/plc/program_options.hpp"
#include "tools/command/running/saved_programs.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/command/timing/bench_comparison.hpp"
#include "tools/command/timing/bench_program.hpp"
#include "tools/command/verbs/commands.hpp"
#include "tools/host/interruption.hpp"
#include "tools/host/process.hpp"
#include "tools/measuring/measure.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

struct BenchOptions {
  ProgramOptions program;  // without a path: the slave program that is built in
  Time each = kSecond;     // processor time for each figure
  std::string against;     // an earlier --json
  std::string save;        // where to write the mixed programs
  bool json = false;
};

void print_line(const Figure& figure, const EarlierBench& before) {
  const bool millions = figure.per_second >= 1e6;
  const auto ratio = ratio_of(figure, before);
  const std::string what = figure.takes > 0
                               ? fmt::format("{:>9.2f} {}", figure.takes, figure.unit)
                               : fmt::format("{:>9.1f} {} {} a second", figure.per_second / (millions ? 1e6 : 1e3),
                                             millions ? "million " : "thousand", figure.unit);
  fmt::print("  {:<26} {}{}\n", figure.name, what, ratio ? fmt::format("  {:.2f} times", *ratio) : "");
}

std::optional<SourceText> read_bench_program(const std::string& path) {
  return path.empty() ? read_source(kModbusSlave, "modbus_slave.stl").if_any() : read_program_text(path);
}

void print_figures(const BenchOptions& options, const nlohmann::ordered_json& how, const std::vector<Figure>& figures,
                   const EarlierBench& before) {
  if (options.json) {
    auto results = results_of("bench");
    results.update(how);
    results["figures"] = nlohmann::ordered_json::array();
    for (const Figure& f : figures) results["figures"].push_back(json_of(f, before));
    fmt::print("{}", lines_of(results));
    return;
  }
  const std::string build = how["build"];
  fmt::print("{}: best of up to {} rounds on one core{}{}\n", stl::printable(how["program"].get<std::string>()), kRounds,
             build == "Release" ? "" : fmt::format(" ({} build, not Release)", build),
             options.against.empty()
                 ? ""
                 : fmt::format("; \"2.00 times\" is twice as fast as in {}", stl::printable(options.against)));
  for (const Figure& f : figures) print_line(f, before);
}

int run_bench(const BenchOptions& options) {
  if (!options.save.empty()) return save_programs(options.save);
  int exit_code = kUnusable;
  const auto text = read_bench_program(options.program.path);
  const auto program = text ? options.program.load(*text, exit_code) : nullptr;
  if (!program) return exit_code;
  const auto before = options.against.empty() ? EarlierBench{} : read_earlier_bench(options.against);
  if (!before) return kUnusable;
  const auto how = measured_with(options.program, *program, options.each);
  if (!options.against.empty()) warn_of_differences(how, *before, options.against);
  catch_interruption();
  const Effort effort{options.each, interruption()};
  std::vector<Figure> figures = measure(program, effort);
  const auto add = [&](const std::vector<Figure>& others) { std::ranges::copy(others, std::back_inserter(figures)); };
  if (options.program.path.empty()) {
    add(measure_tip_like(effort, options.program.every_scan));
    add(measure_mixed(effort));
    add(measure_files(effort));
  }
  add(measure_start(own_executable(), effort));
  print_figures(options, how, figures, *before);
  print_interruption();
  return interrupted() ? kCheckFailed : kFine;
}

}  // namespace

void add_bench(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<BenchOptions>();
  CLI::App* verb = app.add_subcommand("bench", "how fast programs run here");
  verb->add_option("PROGRAM", options->program.path,
                   "a Modbus slave at address 1 (default: our modbus_slave.stl, built in)");
  options->program.CpuOptions::add_to(*verb);
  add_duration(*verb, "--each", options->each, "processor time to spend on each figure, 1ms to 1h [1s]",
               {kMillisecond, 3600 * kSecond});
  verb->add_option("--against", options->against, "an earlier result of --json: how many times as fast it is now")
      ->type_name("FILE");
  verb->add_flag("--json", options->json, "print as JSON");
  auto* save = verb->add_option("--save-programs", options->save,
                                "only write the mixed programs, for a CPU 226XM, and long listings to DIR, which is made");
  save->type_name("DIR");
  for (const char* const of_measuring : {"PROGRAM", "--against", "--json"}) save->excludes(verb->get_option(of_measuring));
  verb->footer(
      "'idle scans', 'instruction trace' and the mixed programs always run every scan. 'tip-like' is a slave that makes a "
      "table in its first scan and receives each character in an interrupt, as that of Application Tip 41 does. The start "
      "is the shortest of all that the time has room for, by the clock.\n"
      "Exit code 1 if it was interrupted, with the figures measured until then.\n"
      "Example: s7200 bench");
  verb->callback([options, &exit_code] { exit_code = run_bench(*options); });
}

}  // namespace s7200::tools
