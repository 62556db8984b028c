#include "tools/command/running/run_output.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/bridge/bridge.hpp"
#include "tools/command/running/rig_output.hpp"
#include "tools/command/terminal/progress.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/rig/run.hpp"
#include "tools/views/report.hpp"
#include "tools/views/results_json.hpp"
#include "tools/views/state/memory.hpp"

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

void print_program(const Rig& rig, const Ending& ending) {
  const State& state = rig.cpu().state();
  fmt::print("{} after {}: {}, {} instructions, CPU in {}\n", ending_text(ending.reason), format_duration(state.time, 6),
             counted(state.scans, "scan"), state.instructions, mode_of(rig.plc(0)));
  if (state.scans)
    fmt::print("scan time: shortest {}, longest {}\n", format_duration(state.shortest_scan),
               format_duration(state.longest_scan));
}

void print_system(const Rig& rig, const Ending& ending) {
  const SystemPlan& plan = rig.plan();
  fmt::print("{} after {}: {}\n", ending_text(ending.reason), format_duration(rig.time(), 6), who_there_was(plan));
  for (std::size_t i = 0; i < plan.plcs.size(); ++i) {
    const State& state = rig.plc(i).cpu().state();
    fmt::print("{}: {}, {} instructions, CPU {} {}\n", stl::printable(plan.plcs[i].name), counted(state.scans, "scan"),
               state.instructions, plan.plcs[i].program->model->name,
               rig.plc(i).powered() ? fmt::format("in {}", mode_of(rig.plc(i))) : "without power");
    fmt::print("{}", indented(errors_text(rig.plc(i).cpu())));
    fmt::print("{}", indented(dumps_text(plan.plcs[i].settings, rig.plc(i).cpu())));
  }
  for (std::size_t i = 0; i < plan.peers.size(); ++i)
    if (const serial::Poller* poller = rig.poller(i))
      fmt::print("{}: {}\n", stl::printable(plan.peers[i].name), poll_text(poller->state()));
}

}  // namespace

void print_text(const Rig& rig, const Ending& ending, Bridges bridges) {
  const bool is_program = is_of_one_program(rig.plan());
  (is_program ? print_program : print_system)(rig, ending);
  for (std::size_t i = 0; i < bridges.size(); ++i)
    fmt::print("{}{}\n", is_program ? "" : stl::printable(rig.plan().bridges[i].name) + ": ",
               stl::printable(bridges[i]->summary()));
  if (ending.pace)
    fmt::print("real time{}: drift {}, worst lag {}\n",
               ending.pace->speed == 1 ? "" : fmt::format(" times {:g}", ending.pace->speed),
               format_duration(ending.pace->drift), format_duration(ending.pace->worst_lag));
  if (is_program) fmt::print("{}{}", errors_text(rig), dump_text(rig));
}

void print_json(const Rig& rig, const Ending& ending, Bridges bridges, const nlohmann::ordered_json& more) {
  const bool is_program = is_of_one_program(rig.plan());
  auto results = results_of("run");
  results["stop_reason"] = ending.reason;
  results["time_ns"] = is_program ? rig.cpu().time() : rig.time();
  if (is_program) {
    results.update(scans_json(rig.cpu().state()));
    results["instructions"] = rig.cpu().state().instructions;
  } else {
    for (const char* const list : {"plcs", "masters", "bridges", "lines"}) results[list] = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < bridges.size(); ++i)
      results["bridges"].push_back({{"name", rig.plan().bridges[i].name}, {"summary", bridges[i]->summary()}});
  }
  results.update(rig_json(rig));
  if (ending.pace)
    results["realtime"] = {
        {"speed", ending.pace->speed}, {"drift_ns", ending.pace->drift}, {"worst_lag_ns", ending.pace->worst_lag}};
  if (is_program && !bridges.empty()) results["bridge"] = bridges.front()->json();
  results.update(more);
  fmt::print("{}", lines_of(results));
}

std::string error_at_end(std::string_view reason, const Rig& rig) {
  if (reason == "endless scan")
    return fmt::format(
        "scan {} has lasted {} and is not over: the program loops in it, and WDR keeps it going. "
        "To run it all the same say how long: --for",
        rig.cpu().state().scans + 1, format_duration(kEndlessScan));
  return reason == "run-time error" ? "--strict: the run ended at the first run-time error" : "";
}

void note_events_to_come(const Rig& rig) {
  const Time end = rig.time();
  const auto& events = rig.plan().events;
  const auto first = std::ranges::find_if(events, [&](const EventPlan& event) { return event.at > end; });
  if (first == events.end()) return;
  print_note(fmt::format("the run ended before {}, the first at {}: --for says how long to run",
                         counted(static_cast<std::size_t>(events.end() - first), "event"), format_duration(first->at)));
}

}  // namespace s7200::tools
