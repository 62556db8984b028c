#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "interpreter/base/text.hpp"
#include "tools/command/bench_program.hpp"
#include "tools/command/commands.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/options/number_option.hpp"
#include "tools/command/options/program_options.hpp"
#include "tools/rig/measure.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

struct BenchOptions {
  ProgramOptions program;  // without a path: the slave program that is built in
  Time each = kSecond;     // host time for each figure
  bool json = false;
};

std::optional<SourceText> read_bench_program(const std::string& path) {
  std::string why;
  return path.empty() ? read_source(kModbusSlave, "modbus_slave.stl", why) : read_program_text(path);
}

int run_bench(const BenchOptions& options) {
  int exit_code = kUnusable;
  const auto text = read_bench_program(options.program.path);
  const auto program = text ? options.program.load(*text, exit_code) : nullptr;
  if (!program) return exit_code;
  const std::vector<Figure> figures = measure(program, options.each);
  if (options.json) {
    auto results = results_of("bench");
    results["program"] = program->source.name;
    for (const Figure& f : figures)
      results["figures"].push_back({{"name", f.name}, {"unit", f.unit}, {"per_second", f.per_second}});
    fmt::print("{}", lines_of(results));
    return kFine;
  }
  fmt::print("{}: best of five rounds on one core\n", stl::printable(program->source.name));
  for (const Figure& f : figures) {
    const bool millions = f.per_second >= 1e6;
    fmt::print("  {:<26} {:>9.1f} {} {} a second\n", f.name, f.per_second / (millions ? 1e6 : 1e3),
               millions ? "million " : "thousand", f.unit);
  }
  return kFine;
}

}  // namespace

void add_bench(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<BenchOptions>();
  CLI::App* verb = app.add_subcommand("bench", "how fast programs run here");
  verb->add_option("PROGRAM", options->program.path,
                   "a Modbus slave at address 1 (default: our modbus_slave.stl, built in)");
  options->program.CpuOptions::add_to(*verb);
  add_duration(*verb, "--each", options->each, "time to spend on each figure [1s]", {kMillisecond, 3600 * kSecond});
  verb->add_flag("--json", options->json, "print as JSON");
  verb->footer("Example: s7200 bench");
  verb->callback([options, &exit_code] { exit_code = run_bench(*options); });
}

}  // namespace s7200::tools
