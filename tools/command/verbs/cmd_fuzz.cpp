#include <CLI/CLI.hpp>
#include <memory>

#include "tools/command/options/number_option.hpp"
#include "tools/command/options/plc/stand_in_options.hpp"
#include "tools/command/testing/fuzz_run.hpp"
#include "tools/command/verbs/commands.hpp"

namespace s7200::tools {

void add_fuzz(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<FuzzOptions>();
  CLI::App* verb = app.add_subcommand("fuzz", "try frames, inputs and times that nobody thought of");
  verb->add_option("PROGRAM", options->files, "an STL file or published document; symbol tables and data blocks")
      ->required();
  options->cpu.add_cpu_and_times_to(*verb, fmt::format("CPU that it is to run on {}", kCpuFound));
  add_repair_option(*verb, options->cpu.repairs);
  add_no_stand_ins_option(*verb, options->cpu.no_stand_ins);
  add_trial_options(*verb, options->bound);
  verb->add_option("--writes", options->writes, "V memory that the program may write; any other write is wrong (repeatable)")
      ->type_name("FIRST..LAST")
      ->allow_extra_args(false);
  verb->add_option("--never", options->never, "what must not hold at the end of any scan (repeatable)")
      ->type_name("EXPRESSION")
      ->allow_extra_args(false);
  add_duration(*verb, "--answers-within", options->answers_within,
               "how long a request that was answered before may go without an answer [2s]",
               {kMillisecond, kLongestDuration});
  verb->add_option("--write", options->folder, "write each finding as a scenario that fails because of it")
      ->type_name("DIR");
  verb->add_flag("--json", options->json, "print the results as JSON");
  verb->footer(
      "It finds STOP, run-time errors, forbidden writes, a slave that stops answering, broken rules.\n"
      "Topics: models, programs, times\n"
      "Example: s7200 fuzz stl_programs/text_commands.stl --seconds 1 --never 'Q0.0 AND Q0.1'");
  verb->callback([options, &exit_code] { exit_code = run_fuzz(*options); });
}

}  // namespace s7200::tools
