#include "tools/command/options/verb/debug_options.hpp"

#include <CLI/CLI.hpp>

#include "tools/command/options/help_groups.hpp"
#include "tools/command/options/plc/line_options.hpp"

namespace s7200::tools {

void DebuggeeOptions::add_program_to(CLI::App& app) {
  program.add_files_to(app);
  program.CpuOptions::add_to(app);
}

void DebuggeeOptions::add_plant_to(CLI::App& app) {
  add_master_options(app, master);
  bridge.add_pace(app);
  bridge.add_bridges(app);
  rig.add_to(app);
  rig.add_first_station_to(app);
  for (const char* rare : {"--baud", "--parity", "--timeout", "--strict", "--output", "--memory"})
    app.get_option(rare)->group(help_group::kMore);
}

void DebugOptions::add_to(CLI::App& app) {
  add_program_to(app);
  app.add_option("--commands", commands_file, "commands to execute, one a line; // begins a comment")
      ->type_name("FILE")
      ->group(help_group::kCommands);
  app.add_option("-x,--execute", commands, "commands to execute, with semicolons between them (repeatable, after --commands)")
      ->type_name("COMMANDS")
      ->allow_extra_args(false)
      ->group(help_group::kCommands);
  app.add_flag("-i,--interactive", interactive, "go on with standard input after --commands and -x")
      ->group(help_group::kCommands);
  app.add_option("--only", only, "of a file of scenarios: the first that fails with PATTERN in its name; * is anything")
      ->type_name("PATTERN")
      ->group(help_group::kCommands);
  app.add_option("--target", target, "of a file of scenarios: the program to run it on")->type_name("PROGRAM");
  add_plant_to(app);
  report.add_to(app, "a page for browsers that computes the session again; any moment of it, without s7200");
}

}  // namespace s7200::tools
