#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "tools/command/inspecting/compare_run.hpp"
#include "tools/command/options/plc/stand_in_options.hpp"
#include "tools/command/verbs/commands.hpp"

namespace s7200::tools {

void add_compare(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* verb = app.add_subcommand("compare", "what differs between two programs");
  verb->add_option("PROGRAM", options->files.words,
                   "OLD and NEW: STL files or published documents; symbol tables and data blocks of both")
      ->required();
  verb->add_option("--with-old", options->files.old_parts, "another file of the old project alone")
      ->type_name("FILE")
      ->allow_extra_args(false);
  verb->add_option("--with-new", options->files.new_parts, "another file of the new project alone")
      ->type_name("FILE")
      ->allow_extra_args(false);
  options->cpu.add_cpu_and_times_to(*verb, fmt::format("CPU that they are to run on {}", kCpuFound));
  add_repair_option(*verb, options->cpu.repairs);
  add_no_stand_ins_option(*verb, options->cpu.no_stand_ins);
  add_trial_options(*verb, options->bound);
  verb->add_option("--watch", options->watched, "memory that is to be the same as well, besides the outputs (repeatable)")
      ->type_name("ADDRESS[:COUNT]")
      ->allow_extra_args(false);
  verb->add_option("--write", options->write, "write the difference as a scenario: OLD passes it, NEW fails it")
      ->type_name("FILE");
  verb->add_flag("--structure", options->structure_alone, "compare only how they are written, run nothing");
  verb->add_flag("--json", options->json, "print the results as JSON");
  verb->footer(
      "Exit code 0: the CPU gets the same; symbols, titles and comments may differ.\n"
      "Topics: models, programs, times\n"
      "Example: s7200 compare stl_programs/modbus_master_214.stl stl_programs/modbus_master.stl");
  verb->callback([options, &exit_code] { exit_code = run_compare(*options); });
}

}  // namespace s7200::tools
