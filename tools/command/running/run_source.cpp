#include "tools/command/running/run_source.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <stdexcept>
#include <string_view>

#include "interpreter/base/text/text.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/options/plc/stand_in_options.hpp"
#include "tools/command/options/plc/system_options.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/slave/slave_target.hpp"

namespace s7200::tools {
namespace {

/// False after a message if something was given that only an S7-200 has a use for.
bool refuse_options_of_s7200(const CLI::App& verb, const RunOptions& options) {
  const auto refused = [](const CLI::Option& option) {
    const std::string& name = option.get_name();
    return name == "--scans" || name == kNoSkip || name == kNoStandIns || name.starts_with("--coverage") || name.starts_with("--profile") ||
           (is_about_one_plc(name) && !is_about_the_line(name));
  };
  for (const CLI::Option* option : verb.get_options())
    if (option->count() > 0 && !option->get_positional() && refused(*option))
      return print_error(option->get_name() + " needs a PROGRAM to run"), false;
  if (options.program.parts.empty()) return true;
  print_error(fmt::format("{} beside {}: there is no program that it could belong to", options.program.parts.front(),
                          options.program.path));
  return false;
}

/// The PLC and the bridge on a line. Throws std::invalid_argument.
SystemPlan plan_behind_bridge(const RunOptions& options, const std::vector<serial::Fault>& faults) {
  const std::string model = parse_slave_target(options.program.path).path;
  std::shared_ptr<westinghouse::Plc> plc = options.other.make(*options.protocol, model);
  if (plc->needs_sync())
    throw std::invalid_argument(
        "no bridge carries the sync signal that this PLC needs to hear anything: give --plc sync=ignored");
  SystemPlan plan = plan_of_other_plc(std::move(plc), faults, options.rig.settings().captures);
  plan.peers.front().name = model;
  plan.bridges.push_back({.name = "bridge", .where = ""});
  LinePlan& line = plan.lines.front();
  line.name = "line";
  line.settings = options.bridge.line();
  line.stations.push_back({.kind = StationPlan::Kind::Bridge});
  return plan;
}

std::optional<RunBridges> load_other_plc(const CLI::App& verb, RunOptions& options) {
  if (!refuse_options_of_s7200(verb, options)) return {};
  const auto faults = options.rig.faults();
  if (!faults || !options.bridge.prepare()) return {};
  Bridge* const bridge = options.bridge.bridge();
  if (!bridge)
    return print_error(fmt::format("nobody asks {}: give it a bridge, such as --pty LINK, or ask it with 's7200 master'",
                                   stl::printable(options.program.path))),
           std::nullopt;
  try {
    options.rig.take_whole(plan_behind_bridge(options, *faults));
  } catch (const std::invalid_argument& error) {
    return print_error(error.what()), std::nullopt;
  }
  return RunBridges{.of_plan = {bridge}};
}

}  // namespace

std::optional<RunBridges> load_run(const CLI::App& verb, RunOptions& options, int& exit_code) {
  exit_code = kUnusable;
  if (is_other_plc(options.program.path)) return load_other_plc(verb, options);
  for (const CLI::Option* option : options.for_other_plcs)
    if (option->count() > 0) return print_error(option->get_name() + " needs westinghouse:MODEL"), std::nullopt;
  std::vector<std::string_view> of_one_plc{"--scans", "--timeout"};
  for (const BridgeRow& bridge : kBridges) of_one_plc.push_back(bridge.option);
  if (!options.rig.load_whole(verb, options.program, of_one_plc, exit_code)) return {};
  exit_code = kUnusable;
  auto of_file = make_bridges(options.rig.plan());
  if (!of_file || !options.bridge.prepare()) return {};
  RunBridges bridges{.of_file = std::move(*of_file), .joined = options.bridge.bridge()};
  bridges.of_plan = those_of(bridges.of_file);
  return bridges;
}

}  // namespace s7200::tools
