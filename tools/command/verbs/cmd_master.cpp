#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "tools/command/exit_code.hpp"
#include "tools/command/options/verb/master_options.hpp"
#include "tools/command/polling/master_menu.hpp"
#include "tools/command/polling/master_output.hpp"
#include "tools/command/polling/master_run.hpp"
#include "tools/command/running/unanswered.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/command/verbs/commands.hpp"
#include "tools/host/interruption.hpp"
#include "tools/host/serial_device.hpp"

namespace s7200::tools {
namespace {

int run_master(const CLI::App& verb, MasterOptions& options) {
  const SlaveTarget target = parse_slave_target(options.target);
  options.refuse_what_does_not_fit(target.kind);
  const bool over_tcp = target.kind == SlaveTarget::Kind::ModbusTcp;
  const std::vector<MasterAction> actions = options.actions(over_tcp);
  print_note_if_any(options.doubt(actions, over_tcp));
  const bool is_program = target.kind == SlaveTarget::Kind::Program;
  if (is_program && options.band.wanted()) return run_on_program_band(options, actions);
  if (is_program || target.kind == SlaveTarget::Kind::System) return run_on_program(verb, options, actions);
  catch_interruption();  // a simulation does so when its files are read
  if (target.kind == SlaveTarget::Kind::Peer) return run_on_peer(options, target.path, actions);
  std::unique_ptr<Slave> slave;
  const auto format = [&](const serial::MasterSettings& master) { return master.over(options.protocol->format); };
  const auto open = [&](const serial::MasterSettings& master) {
    return connect(target, format(master), options.protocol->is_complete, interruption());
  };
  try {
    if (options.wants_menu()) {
      const bool has_port = target.kind == SlaveTarget::Kind::Device;
      const auto of_device = [&](const serial::MasterSettings& master) {
        return has_port ? std::optional(format(master)) : std::nullopt;
      };
      return run_menu(options, {.open = open, .format = of_device, .over_modbus_tcp = over_tcp});
    }
    slave = open(options.master);
  } catch (const SlaveUnreachable& error) {
    print_error(error.what());
    return kUnusable;
  }
  MasterSession session(*slave, actions, options.session(!over_tcp));
  MasterOutput output(options.output(), slave->name());
  bool any_unanswered = false;
  const int exit_code = run_session(
      options, session, actions, output, [] { return false; }, RigOptions::no_json,
      [&](const MasterResult& result) { any_unanswered |= result.exchange.timed_out; });
  if (any_unanswered) print_note(note_on_unknown_causes(slave->name(), false));
  return exit_code;
}

}  // namespace

void add_master(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<MasterOptions>();
  CLI::App* verb = app.add_subcommand("master", "ask a program, a device or a server, as a master of Modbus or others");
  options->add_to(*verb);
  verb->footer(
      std::string(
          "menu, alone and on a terminal, is a screen to try a Modbus slave by hand: a key for each function, slave, port, "
          "loopbacks and a test without end, with statistics.\n"
          "Topics: protocols, targets, faults, files, systems, times, westinghouse\n"
          "Example: s7200 master stl_programs/modbus_slave.stl write 40011=1234,-5 read 40011:2\n") +
      fmt::format("Example: s7200 master {} --station 3 read 40001:4 --every 1s", example_of_serial_device()));
  verb->callback([options, verb, &exit_code] {
    try {
      exit_code = run_master(*verb, *options);
    } catch (const std::invalid_argument& error) {
      print_error(error.what());
      exit_code = kUnusable;
    }
  });
}

}  // namespace s7200::tools
