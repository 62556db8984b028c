#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "serial_sim/peers/quiet_time.hpp"
#include "tools/command/commands.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/options/line_options.hpp"
#include "tools/command/options/number_option.hpp"
#include "tools/command/send_band.hpp"
#include "tools/command/terminal.hpp"
#include "tools/host/interruption.hpp"
#include "tools/slave/simulated_slave.hpp"
#include "tools/views/faults.hpp"
#include "tools/views/report.hpp"
#include "tools/views/results_json.hpp"
#include "tools/views/streamed_results.hpp"
#include "tools/views/timeline.hpp"

namespace s7200::tools {
namespace {

int run_send(SendOptions& options) {
  if (options.band.wanted()) return run_send_band(options);
  int exit_code = kFine;
  const auto program = options.program.load(exit_code);
  if (!program) return exit_code;
  std::string why;
  const auto frames = options.frames.read(why);
  if (!frames) return print_error(why), kUnusable;
  const auto rig = options.rig.assemble(program, options.json);
  if (!rig) return options.rig.exit_code_without_rig();
  serial::Simulation& simulation = rig->simulation();
  rig->power_up();
  TraceSink* const records = rig->sinks().empty() ? nullptr : &rig->sinks();
  Timeline timeline(program, records, Timeline::Looks::AtInstructions);

  StreamedResults results(results_of("send"), "exchanges");
  SimulatedSlave slave(simulation, options.master, program->source.name);
  const bool ready = slave.wait_until_ready(options.after, why);
  if (ready) print_note_if_any(slave.note_on_port());
  if (!why.empty()) print_error(why);
  std::size_t answered = 0, damaged = 0;
  for (const serial::Frame& frame : *frames) {
    if (!ready || interrupted() || options.rig.failed_strictly(simulation.cpu())) break;
    const serial::Faults::State faults_before = simulation.faults().state();
    timeline.begin();
    if (options.timeline) simulation.cpu().set_sink(&timeline);
    const Bytes unasked = serial::bytes_of(simulation.master().heard());
    const serial::Exchange exchange = slave.exchange(options.master.request(frame));
    simulation.cpu().set_sink(records);
    if (simulation.master().busy()) break;  // Ctrl-C came before the answer
    answered += !exchange.timed_out;
    damaged += is_damaged(exchange);
    if (options.json) {
      auto json = exchange_json(exchange, unasked);
      if (options.rig.faulted()) json["faults"] = faults_json(simulation.faults(), faults_before);
      if (options.timeline) json["timeline"] = to_json(timeline.report(), exchange);
      fmt::print("{}", results.entry(json));
    } else {
      fmt::print("{}{}", unasked_text(unasked), exchange_text(exchange, options.master.timeout));
      if (options.timeline) fmt::print("{}\n", to_text(timeline.report(), exchange, colour_wanted(stdout)));
    }
    slave.wait(options.pause == kNever ? slave.pause() : options.pause);
  }
  const bool all_written = finish(*rig);
  if (options.json) {
    fmt::print("{}", results.end(options.rig.json(simulation)));
  } else {
    fmt::print("{}", options.rig.dump_text(simulation.cpu()));
  }
  fmt::print(stderr, "{}", errors_text(simulation.cpu()));
  print_notes(fault_notes(simulation.faults()));
  if (damaged > 0) print_note(fmt::format("{} of {} answers damaged", damaged, answered));
  if (ready && answered == 0) print_note_if_any(torn_frame_note(options.frames.in_hex()));
  if (simulation.cpu().state().mode == Mode::Stop) print_note("the CPU is in STOP");
  if (!all_written) return kUnusable;
  if (simulation.cpu().state().fatal_code) return kCpuFatal;
  print_interruption();
  if (options.rig.failed_strictly(simulation.cpu())) {
    print_error("--strict: a run-time error ended the exchanges");
    return kCheckFailed;
  }
  return answered == frames->size() && damaged == 0 && !interrupted() ? kFine : kCheckFailed;
}

}  // namespace

void add_send(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<SendOptions>();
  CLI::App* verb = app.add_subcommand("send", "put request frames on the line of a running program, print the answers");
  options->program.add_to(*verb);
  options->frames.add_to(*verb);
  const std::string quiet = serial::default_quiet_text();
  add_duration(*verb, "--after", options->after,
               fmt::format("when to send the first frame [after the first scan and {} of silence]", quiet));
  add_duration(*verb, "--pause", options->pause, fmt::format("pause between an answer and the next frame [{}]", quiet));
  add_master_options(*verb, options->master);
  options->rig.add_to(*verb);
  options->band.add_to(*verb);
  auto* timeline = verb->add_flag("--timeline", options->timeline,
                                  "show what the CPU did during each exchange: characters, interrupts, XMT");
  timeline->excludes(verb->get_option("--times-band"));
  verb->add_flag("--json", options->json, "print the exchanges and the results as JSON");
  verb->footer(
      fault_help() +
      "Exit code 1 if a frame was not answered or the answer was damaged: parity or framing errors, or a wrong CRC\n"
      "in answer to a right one. What an answer says is not judged here but by 's7200 master'. With --times-band it is\n"
      "0 only if all were answered with every table.\n"
      "Example: s7200 send stl_programs/modbus_slave.stl --crc 0106000a1234 0103000a0001");
  verb->callback([options, &exit_code] { exit_code = run_send(*options); });
}

}  // namespace s7200::tools
