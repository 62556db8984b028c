#include "tools/command/polling/master_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "interpreter/model/special_memory.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/polling/master_menu.hpp"
#include "tools/command/reports/run_recorder.hpp"
#include "tools/command/running/band_output.hpp"
#include "tools/command/running/rig_output.hpp"
#include "tools/command/running/unanswered.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/host/interruption.hpp"
#include "tools/rig/first_scans.hpp"
#include "tools/slave/line_of_other_plcs.hpp"
#include "tools/slave/simulated_slave.hpp"
#include "tools/slave/slave_in_rig.hpp"
#include "tools/views/report.hpp"
#include "tools/views/state/faults.hpp"

namespace s7200::tools {
namespace {

/// Why a PPI master cannot join a line: a PLC there is one. Empty if it can.
std::string why_no_other_ppi_master(const Rig& rig, std::size_t line) {
  for (const StationPlan& station : rig.plan().lines[line].stations) {
    if (station.kind != StationPlan::Kind::Plc) continue;
    const std::uint8_t control = rig.plc(station.number).cpu().state().port[station.port].control;
    if ((control & sm::kProtocol) != sm::kPpiMaster) continue;
    const std::string& name = rig.plan().plcs[station.number].name;
    return fmt::format(
        "port {}{} is a PPI master, too ({} = 16#{:02X}): how masters pass the token on is not modelled, so they would "
        "collide",
        station.port, name.empty() ? "" : " of " + name, station.port == 0 ? "SMB30" : "SMB130", control);
  }
  return {};
}

/// The same for whoever speaks `protocol`.
std::string why_no_other_master(const Rig& rig, std::size_t line, const Protocol& protocol) {
  return protocol.wants_freeport ? std::string() : why_no_other_ppi_master(rig, line);
}

/// Who else asks there: masters that a system file names. Empty if none has yet.
std::vector<std::string> notes_on_other_masters(const Rig& rig, std::size_t line) {
  std::vector<std::string> notes;
  for (const StationPlan& station : rig.plan().lines[line].stations) {
    const serial::Poller* const poller = station.kind == StationPlan::Kind::Peer ? rig.poller(station.number) : nullptr;
    if (poller == nullptr || poller->state().asked == 0) continue;
    notes.push_back(fmt::format("{} is a master on line {}, too: what both ask at the same time collides",
                                rig.plan().peers[station.number].name, rig.plan().lines[line].name));
  }
  return notes;
}

/// Whether there is an answer on the line when its S7-200 is in STOP: its own in PPI, or that of another PLC.
bool somebody_answers_in_stop(const Rig& rig, std::size_t line, const Protocol& protocol) {
  return !protocol.wants_freeport || std::ranges::any_of(rig.plan().lines[line].stations, [&](const StationPlan& station) {
    return station.kind == StationPlan::Kind::Peer && rig.plan().peers[station.number].automaton != nullptr;
  });
}

}  // namespace

int run_session(const MasterOptions& options, MasterSession& session, const std::vector<MasterAction>& actions,
                MasterOutput& output, const std::function<bool()>& over,
                const std::function<nlohmann::ordered_json()>& plant, const std::function<void(const MasterResult&)>& seen) {
  std::string error;
  output.begin();
  try {
    const auto show = [&](const MasterResult& result) {
      seen(result);
      output.show(result);
    };
    session.run({show, [&] { output.end_round(session.statistics()); }}, over);
  } catch (const std::exception& end) {  // SlaveUnreachable, or a frame that cannot be sent to this slave
    error = end.what();
  }
  output.end(session.statistics(), error, plant());
  if (!error.empty()) {
    print_error(error);
    return kUnusable;
  }
  if (!session.statistics().latency()) print_note_if_any(torn_frame_note(raw_frames(actions)));
  const bool cut_short = interrupted() && !options.open_ended();
  if (cut_short) print_interruption();
  return session.statistics().any_failed() || cut_short ? kCheckFailed : kFine;
}

int run_on_program_band(MasterOptions& options, const std::vector<MasterAction>& actions) {
  options.program.path = options.target;
  BandExchanges exchanges{
      .verb = "master", .key = "action", .labels = {}, .good = verdict_name(serial::Verdict::Right), .run = {}};
  for (const MasterAction& action : actions)
    if (action.request) exchanges.labels.push_back({action.text, action.text});
  exchanges.run = [&](Rig& rig, const std::string& name, LostEvents& lost, RunRecorder* recorder) {
    SimulatedSlave slave(rig.simulation(), options.master, name, !options.protocol->wants_freeport);
    if (recorder) recorder->listen_to(slave);
    MasterSession session(slave, actions, options.session(true));
    std::vector<BandOutcome> outcomes;
    if (!slave.wait_until_ready(options.after)) return outcomes;
    if (const std::string why = why_no_other_master(rig, 0, *options.protocol); !why.empty())
      throw std::invalid_argument(why);
    lost.take();
    const auto add = [&](const MasterResult& result) {
      outcomes.push_back({result.exchange, verdict_name(result.answer.verdict), lost.take(), stop_text(rig.cpu())});
    };
    session.run({add, [] {}}, [] { return false; });
    return outcomes;
  };
  return run_band(options.band, options.program, options.rig, options.report, options.json, exchanges);
}

/// A line of a system where all PLCs are of another make.
static int run_on_line(MasterOptions& options, RecordedRig& rig, const std::vector<MasterAction>& actions) {
  const std::size_t line = options.rig.line();
  LineOfOtherPlcs slave(rig, line, options.master, options.rig.target());
  if (!slave.wait_until_ready(options.after)) return print_interruption(), kCheckFailed;
  int exit_code = kFine;
  if (options.wants_menu()) {
    const auto open = [&](const serial::MasterSettings& master) {
      return std::make_unique<LineOfOtherPlcs>(rig, line, on_line(master, rig.plan().lines[line]), options.rig.target());
    };
    const auto format = [&](const serial::MasterSettings& master) {
      return on_line(master, rig.plan().lines[line]).over(format_without_s7200(rig.plan(), rig.plan().lines[line]));
    };
    exit_code = run_menu(options, {.open = open, .format = format});
  } else {
    MasterSession session(slave, actions, options.session(true));
    MasterOutput output(options.output(), slave.name());
    bool any_unanswered = false;
    exit_code = run_session(
        options, session, actions, output, [] { return false; }, [&] { return rig_json(rig); },
        [&](const MasterResult& result) { any_unanswered |= result.exchange.timed_out; });
    if (any_unanswered) print_note(note_on_unknown_causes(slave.name(), true));
  }
  const bool all_written = finish(rig);
  print_notes(notes_on_other_masters(rig, line));
  print_notes(line_notes(rig));
  return all_written ? exit_code : kUnusable;
}

int run_on_program(const CLI::App& verb, MasterOptions& options, const std::vector<MasterAction>& actions) {
  int exit_code = kFine;
  options.program.path = options.target;
  if (!options.rig.load(verb, options.program, exit_code)) return exit_code;
  options.master = options.rig.on_line(options.master);
  if (!options.report.prepare_for(options.rig.plan())) return kUnusable;
  const auto rig = options.rig.assemble(options.json);
  if (!rig) return options.rig.exit_code_without_rig();
  rig->power_up();
  const auto recorder =
      options.report.wanted() ? std::make_unique<RunRecorder>(*rig, options.rig.system_path(), options.rig.spot()) : nullptr;
  if (options.rig.without_s7200()) return run_on_line(options, *rig, actions);
  Unanswered unanswered(*rig, options.rig.spot());
  UnansweredRequests why_none;
  const auto plant = [&] {
    why_none = unanswered.explained(options.master.timeout);
    return with_why(rig_json(*rig), why_none);
  };
  SimulatedSlave slave(rig->simulation(), options.master, options.rig.target(),
                       somebody_answers_in_stop(*rig, options.rig.line(), *options.protocol));
  unanswered.listen_to(slave);
  if (recorder) recorder->listen_to(slave);
  MasterSession session(slave, actions, options.session(true));
  MasterOutput output(options.output(), slave.name());
  if (options.after == kNever) run_first_scans(*rig, kReadyWithin);
  const auto ready = slave.wait_until_ready(options.after);
  const std::string why = ready ? why_no_other_master(*rig, options.rig.line(), *options.protocol) : ready.why();
  if (ready && !why.empty()) {
    print_error(why);
    output.begin();
    output.end(session.statistics(), why, plant());
    exit_code = kUnusable;
  } else if (ready && options.wants_menu()) {
    serial::Simulation& simulation = rig->simulation();
    const auto open = [&](const serial::MasterSettings& master) {
      return std::make_unique<SimulatedSlave>(simulation, master, options.rig.target());
    };
    const auto format = [&](const serial::MasterSettings& master) { return master.over(simulation.port_format()); };
    exit_code = run_menu(options, {.open = open, .format = format});
  } else if (ready) {
    const std::string note = slave.note_on_port(options.protocol->wants_freeport);
    print_note_if_any(note);
    exit_code = run_session(
        options, session, actions, output, [&] { return options.rig.failed_strictly(rig->cpu()); }, plant,
        [&](const MasterResult& result) { unanswered.note(result.exchange); });
    if (note.empty() && !options.protocol->wants_freeport) print_note_if_any(slave.note_on_port(false));
  } else {
    if (!why.empty()) print_error(why);
    output.begin();
    if (options.json) output.end(session.statistics(), "the program was not ready for the first request", plant());
    exit_code = kCheckFailed;
  }
  const bool report_written = write_report(options.report, "master", recorder.get(), options.program.repairs);
  const bool all_written = finish(*rig) && report_written;
  if (ready && !options.json) fmt::print("{}{}", why_text(why_none), dump_text(*rig));
  fmt::print(stderr, "{}", errors_text(*rig));
  const bool fatal = exit_code_of(*rig) == kCpuFatal, stopped = rig->cpu().state().mode == Mode::Stop;
  if (!ready && stopped && !fatal) print_error("the CPU went to STOP before the first request");
  if (!ready) print_interruption();
  if (ready) print_notes(notes_on_other_masters(*rig, options.rig.line()));
  if (ready) print_notes(line_notes(*rig));
  if (ready) print_notes(stop_notes(*rig));
  if (!all_written) return kUnusable;
  if (fatal) return kCpuFatal;
  if (!ready || !options.rig.failed_strictly(rig->cpu())) return exit_code;
  print_error("--strict: a run-time error ended the session");
  return kCheckFailed;
}

int run_on_peer(MasterOptions& options, const std::string& model, const std::vector<MasterAction>& actions) {
  const auto faults = options.rig.faults();
  if (!faults) return kUnusable;
  const auto plan_with = [&](const std::vector<std::string>& captures) {
    return plan_of_other_plc(options.other.make(*options.protocol, model), *faults, captures);
  };
  const std::vector<std::string>& captures = options.rig.settings().captures;
  if (options.wants_menu()) {
    if (!captures.empty())
      throw std::invalid_argument(
          "the menu begins with a new westinghouse:MODEL each time its port is set: give actions for --capture");
    const SerialFormat format = options.other.make(*options.protocol, model)->format();
    const auto open = [&](const serial::MasterSettings& master) {
      return join_lines(plan_with({}), 0, master, kNever, options.target, interruption());
    };
    return run_menu(options,
                    {.open = open, .format = [&](const serial::MasterSettings& master) { return master.over(format); }});
  }
  options.rig.take_line(plan_with(captures));
  const auto rig = options.rig.assemble(false);
  if (!rig) return options.rig.exit_code_without_rig();
  rig->power_up();
  LineOfOtherPlcs slave(*rig, 0, options.master, options.target);
  slave.wait_until_ready(kNever);
  MasterSession session(slave, actions, options.session(true));
  MasterOutput output(options.output(), slave.name());
  const auto plant = [&] {
    nlohmann::ordered_json json = RigOptions::no_json();
    json["faults"] = faults_json(rig->faults(0));
    return json;
  };
  const int exit_code = run_session(
      options, session, actions, output, [] { return false; }, plant);
  print_notes(fault_notes(rig->faults(0)));
  return finish(*rig) ? exit_code : kUnusable;
}

}  // namespace s7200::tools
