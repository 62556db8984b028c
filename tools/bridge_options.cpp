#include "tools/bridge_options.hpp"

#include <CLI/CLI.hpp>

#include "tools/bridge_pty.hpp"

namespace s7200::tools {

void BridgeOptions::add_to(CLI::App& app) {
  app.add_flag("--realtime", realtime_, "as fast as the clock; bridges do so of themselves");
  app.add_option_function<double>(
         "--speed",
         [this](double speed) {
           speed_ = speed;
           speed_given_ = true;
         },
         "that many times as fast as the clock, with or without a bridge: 20, 0.5 (default 1)")
      ->check(CLI::Range(0.001, 1000.0))
      ->type_name("FACTOR");
  app.add_option("--pty", pty_, "join the line to a serial port that other programs open as LINK")->type_name("LINK");
  line_.add_to(app, "as the program set its port; of --pty as far as its client shows it");
}

std::unique_ptr<Bridge> BridgeOptions::make() const {
  if (!pty_.empty()) return make_pty_bridge(pty_, line_);
  return nullptr;
}

}  // namespace s7200::tools
