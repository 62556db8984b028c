#include "tools/command/session_scenario.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "tools/scenario/reader.hpp"
#include "tools/scenario/runner.hpp"
#include "tools/scenario/transcript.hpp"
#include "tools/scenario/transcript_writer.hpp"

namespace s7200::tools {
namespace {

std::string send_text(const serial::Request& request, Time at) {
  std::string text = fmt::format("  - send: {}\n    at: {}\n", serial::to_hex(request.frame), exact(at));
  if (request.gap != 0) text += fmt::format("    gap: {}\n", exact(request.gap));
  if (request.silence) text += fmt::format("    listen: {}\n", exact(*request.silence));
  return text;
}

std::string step_text(const SessionSteps::Step& step) {
  if (step.send) return send_text(*step.send, step.at);
  return fmt::format("  - wait: until {}\n  - {}\n", exact(step.at),
                     step.fault.empty() ? "set: " + assignments_text(step.set) : "fault: " + step.fault);
}

std::string steps_text(const SessionSteps& session) {
  std::string text;
  for (const SessionSteps::Step& step : session.steps) text += step_text(step);
  const bool ends_with_exchange = !session.steps.empty() && session.steps.back().send;
  if (!ends_with_exchange || session.last) text += fmt::format("  - wait: until {}\n", exact(session.end));
  return text;
}

/// What holds at the end, in the form of a transcript.
std::string end_text(const SessionSteps& session) {
  std::string text;
  if (!session.memory.empty()) text += fmt::format("      - memory: {}\n", assignments_text(session.memory));
  if (session.fatal_code != 0)
    text += fmt::format("      - fatal: \"{:04X}\"\n", session.fatal_code);
  else if (session.stopped)
    text += "      - mode: stop\n";
  return text;
}

/// What options have asked for that a scenario has no word for.
std::string_view without_a_key(const DebugOptions& options) {
  if (options.rig.faulted()) return "the line has faults from the start";
  if (!options.rig.settings().memory.path.empty()) return "it began with the memory of --memory";
  if (options.rig.settings().port != 0) return "it is about port 1";
  return {};
}

std::string input_text(const std::string& path) {
  return path.empty() ? "" : fmt::format("input: {}\n", in_quotes(std::filesystem::absolute(path).string()));
}

std::string repairs_text(const Repairs& repairs) {
  return repairs.all ? "all" : fmt::format("{}", fmt::join(repairs.ids, ","));
}

}  // namespace

bool write_session_scenario(const DebugOptions& options, const std::shared_ptr<const Program>& program,
                            const SessionSteps& session, const Destination& to, std::string& why) {
  why = without_a_key(options);
  const std::string steps = steps_text(session);
  if (!why.empty()) return false;
  const std::string name = std::filesystem::path(program->source.name).filename().string();
  ScenarioFile file =
      read_scenarios(fmt::format("name: {}\ncpu: \"{}\"\n{}after: 0 ms\nsteps:\n{}", in_quotes("a session with " + name),
                                 program->model->name, input_text(options.rig.settings().input), steps),
                     to.path);
  if (!file.diagnostics.empty() || file.scenarios.size() != 1) {
    why = file.diagnostics.empty() ? "it has no steps" : file.diagnostics.front().message;
    return false;
  }
  const RigSettings& rig = options.rig.settings();
  Scenario& scenario = file.scenarios.front();
  scenario.program = options.program.path;
  scenario.with = options.program.parts;
  scenario.times = options.program.times_table;
  scenario.line = options.master;
  scenario.repair = repairs_text(options.program.repairs);
  scenario.set = rig.set;
  scenario.clock = rig.clock;
  Report report{&scenario, run_scenario(scenario, {.program = program})};
  const auto bad = std::find_if(report.result.findings.begin(), report.result.findings.end(),
                                [](const Finding& finding) { return finding.what != "mode at the end"; });
  if (bad != report.result.findings.end()) {
    why = fmt::format("as a scenario it does not run the same way: {}, expected {}, found {}", bad->what, bad->expected,
                      bad->found);
    return false;
  }
  if (session.last &&
      (report.result.seen.empty() || report.result.seen.back().exchange.response != session.last->response)) {
    why = "as a scenario it does not run the same way: the last answer differs";
    return false;
  }
  const std::string text =
      transcript_text({report}, {.path = to.path, .recorded_from = name, .by = "s7200 debug, record"}) + end_text(session);
  why = why_not_replayed(text.size());
  return why.empty() && write_result(to, text, why);
}

std::string_view session_scenario_beginning() { return kTranscriptBeginning; }

}  // namespace s7200::tools
