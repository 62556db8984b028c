#include "tools/command/options/verb/send_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "serial_sim/peers/quiet_time.hpp"
#include "tools/command/options/help_groups.hpp"
#include "tools/command/options/number_option.hpp"
#include "tools/command/options/plc/line_options.hpp"

namespace s7200::tools {

void SendOptions::add_to(CLI::App& app) {
  program.add_to(app);
  frames.add_to(app);
  const std::string quiet = serial::default_quiet_text();
  add_duration(app, "--after", after,
               fmt::format("when to send the first frame [after the first scan and {} of silence]", quiet));
  add_duration(app, "--pause", pause, fmt::format("pause between an answer and the next frame [{}]", quiet));
  add_master_options(app, master);
  rig.add_to(app);
  rig.add_place_to(app);
  band.add_to(app);
  app.add_flag("--timeline", timeline, "show what the CPU did during each exchange: characters, interrupts, XMT")
      ->excludes(app.get_option("--times-band"))
      ->group(help_group::kResults);
  report.add_to(app, "a page for browsers that computes the exchanges again; any moment of it, without s7200");
  app.add_flag("--json", json, "print the exchanges and the results as JSON")->group(help_group::kResults);
}

}  // namespace s7200::tools
