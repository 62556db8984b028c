#include "tools/command/system_run.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "interpreter/base/counted.hpp"
#include "interpreter/base/text.hpp"
#include "tools/bridge/live_run.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/options/stand_in_options.hpp"
#include "tools/command/options/system_options.hpp"
#include "tools/command/progress.hpp"
#include "tools/command/rig_output.hpp"
#include "tools/command/system_bridges.hpp"
#include "tools/command/terminal.hpp"
#include "tools/host/interruption.hpp"
#include "tools/rig/rig.hpp"
#include "tools/rig/run.hpp"
#include "tools/slave/slave_target.hpp"
#include "tools/views/memory.hpp"
#include "tools/views/report.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

/// `2 PLCs, 1 master, 2 lines`; a PLC of another make is one too.
std::string who_there_was(const SystemPlan& plan) {
  std::size_t plcs = plan.plcs.size(), masters = 0;
  for (const PeerPlan& peer : plan.peers) {
    plcs += peer.automaton != nullptr;
    masters += !peer.polls.requests.empty();
  }
  return fmt::format("{}{}, {}", counted(plcs, "PLC"), masters ? ", " + counted(masters, "master") : "",
                     counted(plan.lines.size(), "line"));
}

/// How a run ended; no reason after an error.
struct Ending {
  std::string_view reason;
  std::optional<Pace::Report> pace{};                               // of a run in real time
  std::map<const serial::SharedLine*, std::uint64_t> collisions{};  // of masters on bridges, by line
};

Ending run_to_end(Rig& rig, Bridges bridges, const RunOptions& options) {
  const Time end = options.end(!bridges.empty());
  if (bridges.empty() && !options.bridge.realtime()) {
    const RunLimits limits{.end = end};
    return {run(rig, end, Progress([&] { return rig.system().time(); }, limits))};
  }
  const auto machine = machine_of(rig.system());
  LiveRun live(
      *machine, ends_of(rig, bridges),
      {.speed = options.bridge.speed(), .messages = print_live_messages(), .stop = interruption(), .before_wait = [&rig] {
         rig.flush_records();
       }});
  std::string why;
  if (!live.start(why)) return print_error(why), Ending{};
  const serial::Halt halt = live.run_until(end);
  if (!live.failure().empty()) print_error(live.failure());
  Ending ending{!live.failure().empty() ? "bridge" : halt == serial::Halt::Time ? "time" : "interrupted", live.pace()};
  for (std::size_t i = 0; i < rig.plan().lines.size(); ++i) ending.collisions[&rig.line(i)] = live.collisions(&rig.line(i));
  return ending;
}

void print_text(Rig& rig, const Ending& ending, Bridges bridges) {
  const SystemPlan& plan = rig.plan();
  fmt::print("{} after {}: {}\n", ending_text(ending.reason), format_duration(rig.system().time(), 6), who_there_was(plan));
  for (std::size_t i = 0; i < plan.plcs.size(); ++i) {
    const State& state = rig.plc(i).cpu().state();
    fmt::print("{}: {}, {} instructions, CPU {} {}\n", stl::printable(plan.plcs[i].name), counted(state.scans, "scan"),
               state.instructions, plan.plcs[i].program->model->name,
               rig.plc(i).powered() ? fmt::format("in {}", mode_of(rig.plc(i))) : "without power");
    fmt::print("{}", indented(errors_text(rig.plc(i).cpu())));
    for (const MemoryRange& range : plan.plcs[i].settings.dumps)
      fmt::print("{}", indented(dump_text(rig.plc(i).cpu(), range)));
  }
  for (std::size_t i = 0; i < plan.peers.size(); ++i)
    if (const serial::Poller* poller = rig.poller(i))
      fmt::print("{}: {}\n", stl::printable(plan.peers[i].name), poll_text(poller->state()));
  for (std::size_t i = 0; i < bridges.size(); ++i)
    fmt::print("{}: {}\n", stl::printable(plan.bridges[i].name), stl::printable(bridges[i]->summary()));
  if (ending.pace)
    fmt::print("real time{}: drift {}, worst lag {}\n",
               ending.pace->speed == 1 ? "" : fmt::format(" times {:g}", ending.pace->speed),
               format_duration(ending.pace->drift), format_duration(ending.pace->worst_lag));
}

void print_json(Rig& rig, const Ending& ending, Bridges bridges) {
  auto results = results_of("run");
  results["stop_reason"] = ending.reason;
  results["time_ns"] = rig.system().time();
  for (const char* const list : {"plcs", "masters", "bridges", "lines"}) results[list] = nlohmann::ordered_json::array();
  results.update(rig_json(rig));
  for (std::size_t i = 0; i < bridges.size(); ++i)
    results["bridges"].push_back({{"name", rig.plan().bridges[i].name}, {"summary", bridges[i]->summary()}});
  if (ending.pace)
    results["realtime"] = {
        {"speed", ending.pace->speed}, {"drift_ns", ending.pace->drift}, {"worst_lag_ns", ending.pace->worst_lag}};
  fmt::print("{}", lines_of(results));
}

void note_events_to_come(Rig& rig) {
  const Time end = rig.system().time();
  const auto& events = rig.plan().events;
  const auto first = std::ranges::find_if(events, [&](const EventPlan& event) { return event.at > end; });
  if (first == events.end()) return;
  print_note(fmt::format("the run ended before {}, the first at {}: --for says how long to run",
                         counted(static_cast<std::size_t>(events.end() - first), "event"), format_duration(first->at)));
}

int run_plan(SystemPlan plan, const RigSurroundings& surroundings, Bridges bridges, const RunOptions& options) {
  std::vector<std::string> problems;
  const auto rig = Rig::assemble(std::move(plan), surroundings, problems);
  for (const std::string& problem : problems) print_error(problem);
  if (!rig) {
    print_interruption();
    return problems.empty() && interrupted() ? kCheckFailed : kUnusable;
  }
  rig->power_up();
  const Ending ending = run_to_end(*rig, bridges, options);
  if (ending.reason.empty()) return kUnusable;
  problems = rig->finish();
  for (const std::string& problem : problems) print_error(problem);
  if (options.json)
    print_json(*rig, ending, bridges);
  else
    print_text(*rig, ending, bridges);
  print_notes(line_notes(*rig, [&](const serial::SharedLine* line) {
    const auto found = ending.collisions.find(line);
    return found == ending.collisions.end() ? 0 : found->second;
  }));
  if (ending.reason == "time") note_events_to_come(*rig);
  if (!problems.empty() || ending.reason == "bridge") return kUnusable;
  if (ending.reason == "interrupted" && options.has_end(!bridges.empty())) return kCheckFailed;
  return exit_code_of(*rig);
}

/// False after a message if something was given that only an S7-200 has a use for.
bool refuse_options_of_s7200(const CLI::App& verb, const RunOptions& options) {
  const auto refused = [](const CLI::Option& option) {
    const std::string& name = option.get_name();
    return name == "--scans" || name == kNoSkip || name == kNoStandIns ||
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

/// It and the bridge on a line. Throws std::invalid_argument.
SystemPlan plan_of_other_plc(RunOptions& options, const std::vector<serial::Fault>& faults) {
  const std::string model = parse_slave_target(options.program.path).path;
  std::shared_ptr<westinghouse::Plc> plc = options.other.make(*options.protocol, model);
  if (plc->needs_sync())
    throw std::invalid_argument(
        "no bridge carries the sync signal that this PLC needs to hear anything: give --plc sync=ignored");
  SystemPlan plan;
  plan.peers.push_back({.name = model, .automaton = std::move(plc)});
  plan.bridges.push_back({.name = "bridge", .where = ""});
  plan.lines.push_back({.name = "line",
                        .settings = options.bridge.line(),
                        .faults = of_anyone(faults),
                        .captures = options.rig.settings().captures,
                        .stations = {{.kind = StationPlan::Kind::Peer}, {.kind = StationPlan::Kind::Bridge}}});
  return plan;
}

int run_system(const CLI::App& verb, const RunOptions& options) {
  std::vector<std::string_view> of_one_plc{"--scans", "--timeout"};
  for (const BridgeRow& bridge : kBridges) of_one_plc.push_back(bridge.option);
  if (!refuse_options_of_one_plc(verb, options.program, of_one_plc)) return kUnusable;
  if (options.json && options.rig.settings().trace == "-")
    return print_error("--trace - and --json cannot both have standard output; write one to a file"), kUnusable;
  int exit_code = kFine;
  auto plan = load_system(options.program, exit_code);
  if (!plan) return exit_code;
  const auto owned = make_bridges(*plan);
  if (!owned) return kUnusable;
  return run_plan(std::move(*plan), options.rig.surroundings(options.program.path, {}, {}), those_of(*owned), options);
}

int run_other_plc(const CLI::App& verb, RunOptions& options) {
  if (!refuse_options_of_s7200(verb, options)) return kUnusable;
  auto faults = options.rig.faults();
  if (!faults || !options.bridge.prepare()) return kUnusable;
  Bridge* const bridge = options.bridge.bridge();
  if (!bridge)
    return print_error(fmt::format("nobody asks {}: give it a bridge, such as --pty LINK, or ask it with 's7200 master'",
                                   stl::printable(options.program.path))),
           kUnusable;
  try {
    SystemPlan plan = plan_of_other_plc(options, *faults);
    return run_plan(std::move(plan), options.rig.surroundings({}, options.bridge.link(), {}), {&bridge, 1}, options);
  } catch (const std::invalid_argument& error) {
    return print_error(error.what()), kUnusable;
  }
}

}  // namespace

std::optional<int> run_without_program(const CLI::App& verb, RunOptions& options) {
  if (is_other_plc(options.program.path)) return run_other_plc(verb, options);
  for (const CLI::Option* option : options.for_other_plcs)
    if (option->count() > 0) return print_error(option->get_name() + " needs westinghouse:MODEL"), kUnusable;
  if (is_system_file(options.program.path)) return run_system(verb, options);
  return {};
}

}  // namespace s7200::tools
