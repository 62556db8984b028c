#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <ctime>
#include <stdexcept>

#include "interpreter/base/text.hpp"
#include "tools/calibration/fit.hpp"
#include "tools/command/calibrate_output.hpp"
#include "tools/command/commands.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/measuring_target.hpp"
#include "tools/command/options/number_option.hpp"
#include "tools/command/options/program_options.hpp"
#include "tools/command/stl_output.hpp"
#include "tools/command/terminal.hpp"
#include "tools/host/interruption.hpp"
#include "tools/slave/slave_target.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

struct CalibrateOptions {
  std::string target, output, firmware;
  ProgramOptions program;
  Time each = 3 * kSecond;
  bool force = false, json = false;
};

constexpr const char* kHowTo =
    "measure_times.stl must be in the CPU, and the CPU in RUN. To put it there: s7200 convert "
    "stl_programs/measure_times.stl\n"
    "--to microwin, paste the blocks into Micro/WIN, download them to a CPU whose outputs are not wired to a plant, and set "
    "the\n"
    "switch to RUN; then connect port 0 and call this again. It answers at 9600 baud, 8 data bits, even parity.";

std::string today() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  return fmt::format("{}-{:02}-{:02}", local.tm_year + 1900, local.tm_mon + 1, local.tm_mday);
}

void show_progress(std::size_t done, std::size_t all) {
  if (!can_redraw(stderr)) return;
  fmt::print(stderr, "\r{} of {} loops{}", done, all, done == all ? "\r\x1b[K" : "");
  std::fflush(stderr);
}

int run_calibrate(CalibrateOptions& options) {
  const CpuModel* model = options.program.model();
  if (!model) return kUnusable;
  const auto times = options.program.times(*model);
  if (!times) return kUnusable;
  const TimeTable known = default_times(*model);
  const Loops loops = find_loops(*model, known);
  if (loops.loops.empty())
    return print_error(fmt::format("measure_times.stl does not run on CPU {}", model->name)), kUnusable;
  catch_interruption();
  int exit_code = kFine;
  const auto target = MeasuringTarget::open(options.target, options.program, exit_code);
  if (!target) return exit_code;
  Measurement measurement;
  try {
    measurement = measure_loops(target->slave(), loops.loops.size(), options.each,
                                [&](std::size_t done) { show_progress(done, loops.loops.size()); });
  } catch (const std::runtime_error& error) {
    print_error(error.what());
    if (!interrupted()) print_note(kHowTo);
    return interrupted() ? kCheckFailed : kUnusable;
  }
  const Fit result = fit(loops, measurement.loops);
  const std::string source = fmt::format(
      "{} (SMB6 = 16#{:02X}{}), measured {}, loops agree within {:.2f} us", model->name, measurement.identification,
      options.firmware.empty() ? "" : ", firmware " + options.firmware, today(), std::max(0.0, result.contradiction) / 1000);
  const std::string csv = fitted_csv(result, "CPU " + source);
  if (!options.output.empty()) {
    const int written = write_stl(options.output, {options.target}, options.force, csv);
    if (written != kFine) return written;
  }
  if (options.json) {
    fmt::print("{}", lines_of(to_json(*model, measurement, result)));
  } else {
    if (options.output.empty()) print_file(csv);
    fmt::print(stderr, "not measured, or not told apart: {}\n", fmt::join(not_measured(result, *model), " "));
  }
  if (result.contradiction > 0)
    print_note(fmt::format("loops contradict each other by {:.2f} us: some time depends on more than the instruction",
                           result.contradiction / 1000));
  return kFine;
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
  add_duration(*verb, "--each", options->each, "how long each of the loops runs [3s]", {kSecond, 20 * kSecond});
  verb->add_option("--firmware", options->firmware, "release of the CPU's firmware, for the source of the figures")
      ->type_name("TEXT");
  options->program.CpuOptions::add_to(*verb);
  verb->add_flag("--json", options->json, "print what was found as JSON");
  verb->footer(
      fmt::format("{}\n{}Example: s7200 calibrate stl_programs/measure_times.stl --each 1s", kHowTo,
                  slave_targets_help({SlaveTarget::Kind::System, SlaveTarget::Kind::ModbusTcp, SlaveTarget::Kind::Peer})));
  verb->callback([options, &exit_code] { exit_code = run_calibrate(*options); });
}

}  // namespace s7200::tools
