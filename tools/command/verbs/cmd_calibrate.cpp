#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <stdexcept>

#include "interpreter/base/text/text.hpp"
#include "interpreter/model/times/times_file.hpp"
#include "tools/calibration/fit.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/options/number_option.hpp"
#include "tools/command/options/plc/program_options.hpp"
#include "tools/command/reading/stl_output.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/command/timing/calibrate_output.hpp"
#include "tools/command/timing/measuring_target.hpp"
#include "tools/command/verbs/commands.hpp"
#include "tools/host/interruption.hpp"
#include "tools/slave/slave_target.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

struct CalibrateOptions {
  std::string target, output, firmware;
  ProgramOptions program;
  CLI::Option* cpu = nullptr;
  std::vector<CLI::Option*> of_programs;  // about a CPU in simulation
  Time each = 3 * kSecond;
  bool force = false, json = false;
};

bool in_simulation(const CalibrateOptions& options) {
  return parse_slave_target(options.target).kind == SlaveTarget::Kind::Program;
}

void refuse_what_does_not_fit(const CalibrateOptions& options) {
  if (in_simulation(options)) return;
  for (const CLI::Option* option : options.of_programs)
    if (option->count() > 0)
      throw std::invalid_argument(fmt::format("{} needs a PROGRAM to run in simulation", option->get_name()));
}

int run_calibrate(const CalibrateOptions& options) {
  refuse_what_does_not_fit(options);
  const CpuModel* model = options.program.model();
  if (!model || !options.program.times(*model)) return kUnusable;
  const TimeTable known = told_apart(*model);
  const Loops loops = find_loops(*model, known);
  if (loops.loops.empty())
    return print_error(fmt::format("measure_times.stl does not run on CPU {}", model->name)), kUnusable;
  catch_interruption();
  int exit_code = kFine;
  const auto measurement = measure(
      options.target, options.program, loops.loops.size(), options.each,
      [&](std::uint8_t identification) { refuse_another_cpu(*model, identification); }, exit_code);
  if (!measurement) return exit_code;
  const Fit result = fit(loops, measurement->loops);
  const std::string source =
      (in_simulation(options) ? "simulated " : "") + source_of(*model, *measurement, result, options.firmware);
  const std::string interruption = interruption_note(*measurement, loops.loops.size());
  const std::string csv =
      cpu_line(model->name) + comment_line(interruption) + to_csv(calibrated(result, known, default_times(*model), source));
  if (!options.output.empty()) {
    const int written = write_stl(options.output, {options.target}, options.force, csv);
    if (written != kFine) return written;
  }
  if (options.json) {
    fmt::print("{}", lines_of(to_json(*model, *measurement, result)));
  } else {
    if (options.output.empty()) print_file(csv);
    fmt::print(stderr, "{}\n", not_measured_text(result, *model));
  }
  const bool known_cpu = in_simulation(options) || options.cpu->count() > 0;
  print_note_if_any(doubt_about_cpu(*model, measurement->identification, known_cpu));
  print_note_if_any(contradiction_note(result));
  print_note_if_any(interruption);
  return exit_code;
}

/// In a cell of the table.
std::string check_firmware(const std::string& text) {
  return std::ranges::any_of(text, [](unsigned char c) { return c < 0x20 || c == 0x7F; })
             ? "a line break or another control character does not go into a table"
             : "";
}

}  // namespace

void add_calibrate(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<CalibrateOptions>();
  CLI::App* verb = app.add_subcommand("calibrate", "measure the execution times of a CPU that runs measure_times.stl");
  verb->add_option("TARGET", options->target, "where that program runs: a device, an address, or the PROGRAM in simulation")
      ->required();
  verb->add_option("-o,--output", options->output, "write the times to FILE, for --times; without it they are printed")
      ->type_name("FILE");
  verb->add_flag("--force", options->force, "overwrite an existing file");
  add_duration(*verb, "--each", options->each, "how long each of the loops runs, 1s to 20s [3s]", {kSecond, 20 * kSecond});
  verb->add_option("--firmware", options->firmware, "release of the CPU's firmware, for the source of the figures")
      ->check(check_firmware)
      ->type_name("TEXT");
  const std::size_t before = verb->get_options().size();
  options->program.CpuOptions::add_to(*verb);
  options->cpu = verb->get_option("--cpu")->description("CPU that is measured [214]");
  const auto all = verb->get_options();
  for (std::size_t i = before; i < all.size(); ++i)
    if (all[i] != options->cpu) options->of_programs.push_back(all[i]);
  verb->add_flag("--json", options->json, "print what was found as JSON");
  verb->footer(
      how_to_measure("\n") +
      "\nExit code 1 if it was interrupted, 2 if the CPU does not answer or is not that of --cpu; what was measured until "
      "then is kept.\n"
      "Topics: targets, times\n"
      "Example: s7200 calibrate stl_programs/measure_times.stl --each 1s");
  verb->callback([options, &exit_code] { exit_code = run_calibrate(*options); });
}

}  // namespace s7200::tools
