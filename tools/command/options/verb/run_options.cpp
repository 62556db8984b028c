#include "tools/command/options/verb/run_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "tools/command/options/help_groups.hpp"
#include "tools/command/options/number_option.hpp"
#include "tools/plan/system_keys.hpp"

namespace s7200::tools {

void RunOptions::add_to(CLI::App& app) {
  program.add_files_to(app);
  offer_other_plcs(app.get_option("PROGRAM"));
  program.CpuOptions::add_to(app);
  add_duration(app, "--for", duration, "how long, in simulated time [1s; with a bridge until Ctrl-C]")
      ->group(help_group::kRun);
  add_whole_number(app, "--scans", scans, {1, UINT64_MAX}, "how many scans; with --for whichever comes first ends the run")
      ->group(help_group::kRun);
  bridge.add_to(app);
  rig.add_to(app);
  app.get_option("--strict")->group(help_group::kMore);
  report.add_to(app, "a page for browsers that computes this run again; any moment of it, without s7200");
  for_other_plcs = {add_protocol_option(app, protocol, protocols_of_other_plcs(), "what westinghouse:MODEL speaks"),
                    other.add_to(app)};
  app.add_flag_callback(
      "--keys",
      [] {
        fmt::print("{}", system_keys_markdown());
        throw CLI::Success();
      },
      "print what a system file may contain, as Markdown");
  coverage.add_to(app, help_group::kMore);
  profile.add_to(app);
  app.add_flag("--json", json, "print the results as JSON")->group(help_group::kResults);
}

}  // namespace s7200::tools
