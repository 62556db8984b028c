#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "tools/command/exit_code.hpp"
#include "tools/command/running/rig_output.hpp"
#include "tools/command/running/send_band.hpp"
#include "tools/command/running/send_slave.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/command/verbs/commands.hpp"
#include "tools/host/interruption.hpp"
#include "tools/plan/reading/system_reader.hpp"
#include "tools/views/report.hpp"
#include "tools/views/results_json.hpp"
#include "tools/views/state/faults.hpp"
#include "tools/views/streamed_results.hpp"

namespace s7200::tools {
namespace {

int run_send(const CLI::App& verb, SendOptions& options) {
  if (options.band.wanted() && !is_system_file(options.program.path)) return run_send_band(options);
  const auto frames = options.frames.read();
  if (!frames) return print_error(frames.why()), kUnusable;
  int exit_code = kFine;
  if (!options.rig.load(verb, options.program, exit_code)) return exit_code;
  options.master = options.rig.on_line(options.master);
  if (!options.report.prepare_for(options.rig.plan())) return kUnusable;
  const auto rig = options.rig.assemble(options.json);
  if (!rig) return options.rig.exit_code_without_rig();
  rig->power_up();
  const auto recorder =
      options.report.wanted() ? std::make_unique<RunRecorder>(*rig, options.rig.system_path(), options.rig.spot()) : nullptr;
  const std::size_t line = options.rig.line();
  const serial::Requester& master = rig->requester(line)->requester();
  const auto failed_strictly = [&] { return !options.rig.without_s7200() && options.rig.failed_strictly(rig->cpu()); };
  Timelines timelines(*rig);
  const auto unanswered = options.rig.without_s7200() ? nullptr : std::make_unique<Unanswered>(*rig, options.rig.spot());

  StreamedResults results(results_of("send"), "exchanges");
  bool ready = false;
  const std::unique_ptr<SlaveInSimulation> slave = slave_to_send_to(options, *rig, ready, unanswered.get(), recorder.get());
  std::size_t answered = 0, damaged = 0, foreign = 0;
  for (const serial::Frame& frame : *frames) {
    if (!ready || interrupted() || failed_strictly()) break;
    const serial::Faults::State faults_before = rig->faults(line).state();
    if (options.timeline) timelines.begin();
    const Bytes unasked = serial::bytes_of(master.heard());
    serial::Exchange exchange = slave->exchange(options.master.request(frame));
    mark_request_of_another(exchange);
    if (options.timeline) timelines.end();
    if (master.busy()) break;  // Ctrl-C came before the answer
    if (unanswered) unanswered->note(exchange);
    foreign += exchange.of_another_master;
    answered += !exchange.timed_out && !exchange.of_another_master;
    damaged += is_damaged(exchange);
    if (options.json) {
      auto json = exchange_json(exchange, unasked);
      if (options.rig.faulted()) json["faults"] = faults_json(rig->faults(line), faults_before, stations_of(*rig, line));
      if (options.timeline) json["timeline"] = timelines.json(exchange);
      fmt::print("{}", results.entry(json));
    } else {
      fmt::print("{}{}", unasked_text(unasked), exchange_text(exchange, options.master.timeout));
      if (options.timeline) print_report(timelines.text(exchange, colour_wanted(stdout)) + "\n");
    }
    slave->wait(options.pause == kNever ? slave->pause() : options.pause);
  }
  const Bytes at_last = ready ? serial::bytes_of(master.heard()) : Bytes{};
  const bool report_written = write_report(options.report, "send", recorder.get(), options.program.repairs);
  const bool all_written = finish(*rig) && report_written;
  const UnansweredRequests why_none = unanswered ? unanswered->explained(options.master.timeout) : UnansweredRequests{};
  auto end = with_why(rig_json(*rig), why_none);
  if (!at_last.empty()) end["unasked"] = plain_hex(at_last);
  fmt::print("{}", options.json ? results.end(end) : unasked_text(at_last) + why_text(why_none) + dump_text(*rig));
  fmt::print(stderr, "{}", errors_text(*rig));
  if (!unanswered && ready && answered + foreign < frames->size() && !interrupted())
    print_note(note_on_unknown_causes(slave->name(), true));
  print_notes(line_notes(*rig));
  if (damaged > 0) print_note(fmt::format("{} of {} answers damaged", damaged, answered));
  if (foreign > 0)
    print_note(fmt::format("{} of {} frames had no answer: another master's request came first", foreign, frames->size()));
  if (ready && answered == 0) print_note_if_any(torn_frame_note(options.frames.in_hex()));
  if (ready && answered == 0) print_note_if_any(missing_crc_note(*frames));
  if (ready && answered == 0) print_note_if_any(modbus_tcp_note(*frames));
  print_notes(stop_notes(*rig));
  if (!all_written) return kUnusable;
  if (exit_code_of(*rig) != kFine) return exit_code_of(*rig);
  print_interruption();
  if (failed_strictly()) return print_error("--strict: a run-time error ended the exchanges"), kCheckFailed;
  return answered == frames->size() && damaged == 0 && !interrupted() ? kFine : kCheckFailed;
}

}  // namespace

void add_send(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<SendOptions>();
  CLI::App* verb = app.add_subcommand("send", "put request frames on the line of a running program, print the answers");
  options->add_to(*verb);
  verb->footer(
      "A system file (.yaml) instead of a PROGRAM: the frames go onto one of its lines, beside everybody who is there.\n"
      "Exit code 1 if a frame was not answered, or with parity or framing errors or a wrong CRC; what an answer says is "
      "judged by 's7200 master'. With --times-band, for one PROGRAM, it is 0 only if every table answered all.\n"
      "Topics: faults, files, models, programs, systems, times\n"
      "Example: s7200 send stl_programs/modbus_slave.stl --crc 0106000a1234 0103000a0001");
  verb->callback([options, verb, &exit_code] { exit_code = run_send(*verb, *options); });
}

}  // namespace s7200::tools
