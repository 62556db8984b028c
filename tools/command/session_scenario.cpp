#include "tools/command/session_scenario.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "tools/rig/system_reader.hpp"
#include "tools/scenario/reader.hpp"
#include "tools/scenario/runner.hpp"
#include "tools/scenario/transcript.hpp"
#include "tools/scenario/transcript_writer.hpp"
#include "tools/views/machine_text.hpp"

namespace s7200::tools {
namespace {

/// Of a step, and of what is expected at the end.
std::string on_text(const std::string& on, std::string_view indentation) {
  return on.empty() ? "" : fmt::format("{}on: {}\n", indentation, in_quotes(on));
}

std::string send_text(const SessionSteps::Step& step) {
  const serial::Request& request = *step.send;
  std::string text =
      fmt::format("  - send: {}\n    at: {}\n", serial::to_hex(request.frame), exact(step.at)) + on_text(step.on, "    ");
  if (step.timeout) text += fmt::format("    timeout: {}\n", exact(*step.timeout));
  if (request.gap != 0) text += fmt::format("    gap: {}\n", exact(request.gap));
  if (request.silence) text += fmt::format("    listen: {}\n", exact(*request.silence));
  return text;
}

std::string step_text(const SessionSteps::Step& step) {
  if (step.send) return send_text(step);
  if (!step.event.empty()) return fmt::format("  - wait: until {}\n  - {}\n", exact(step.at), step.event);
  if (step.power)
    return fmt::format("  - wait: until {}\n  - power_cycle: memory {}\n", exact(step.at),
                       step.power->memory_lost ? "lost" : "kept") +
           (step.power->off == 0 ? "" : fmt::format("    power_off: {}\n", exact(step.power->off)));
  return fmt::format("  - wait: until {}\n  - {}\n", exact(step.at),
                     step.fault.empty() ? "set: " + assignments_text(step.set) : "fault: " + step.fault) +
         on_text(step.on, "    ");
}

std::string steps_text(const SessionSteps& session) {
  std::string text;
  for (const SessionSteps::Step& step : session.steps) text += step_text(step);
  const bool ends_with_exchange = !session.steps.empty() && session.steps.back().send;
  if (!ends_with_exchange || session.last) text += fmt::format("  - wait: until {}\n", exact(session.end));
  return text;
}

/// How many steps of a scenario one of the session becomes: memory is set, and the like, after a wait.
std::size_t steps_in(const SessionSteps::Step& step) { return step.send ? 1 : 2; }

/// Why the wait in front of that step of the scenario was over before it began: an exchange goes on up to its end first.
std::string why_too_late(const SessionSteps& session, std::size_t number) {
  std::size_t first = 0;
  for (const SessionSteps::Step& step : session.steps) {
    if (number < first + steps_in(step))
      return fmt::format(
          "what was done at {} came while a request or its answer was under way, and the steps of a scenario come one after "
          "the other: do it before 'send', or after the answer",
          moment_text(step.at));
    first += steps_in(step);
  }
  return "it stands directly at an answer, up to which several PLCs of a scenario cannot be run so exactly: 'continue 1ms' "
         "first";
}

/// What holds at the end, in the form of a transcript.
std::string end_text(const SessionSteps& session) {
  constexpr std::string_view kIndentation = "        ";
  std::string text;
  for (const SessionSteps::End& end : session.ends) {
    const std::string on = on_text(end.on, kIndentation);
    if (!end.memory.empty()) text += fmt::format("      - memory: {}\n", assignments_text(end.memory)) + on;
    if (end.fatal_code != 0)
      text += fmt::format("      - fatal: \"{:04X}\"\n", end.fatal_code) + on;
    else if (end.stopped)
      text += "      - mode: stop\n" + on;
  }
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
  const bool is_system = is_system_file(options.program.path);
  const std::string path = is_system ? options.program.path : program->source.name;
  const std::string name = std::filesystem::path(path).filename().string();
  const std::string head =
      is_system ? fmt::format("system: {}\n", in_quotes(std::filesystem::absolute(path).string()))
                : fmt::format("cpu: \"{}\"\n{}", program->model->name, input_text(options.rig.settings().input));
  ScenarioFile file = read_scenarios(
      fmt::format("name: {}\n{}after: 0 ms\nsteps:\n{}", in_quotes("a session with " + name), head, steps), to.path);
  if (!file.diagnostics.empty() || file.scenarios.size() != 1) {
    why = file.diagnostics.empty() ? "it has no steps" : file.diagnostics.front().message;
    return false;
  }
  const RigSettings& rig = options.rig.settings();
  Scenario& scenario = file.scenarios.front();
  scenario.program = is_system ? "" : options.program.path;
  scenario.with = options.program.parts;
  scenario.times = options.program.times_table;
  if (!is_system) scenario.system_block = program->system_block;
  scenario.line = options.master;
  if (!is_system) scenario.repair = repairs_text(options.program.repairs);
  scenario.set = rig.set;
  scenario.clock = rig.clock;
  Report report{&scenario, run_scenario(scenario, {.program = program})};
  const auto bad = std::find_if(report.result.findings.begin(), report.result.findings.end(),
                                [](const Finding& finding) { return finding.what != "mode at the end"; });
  if (bad != report.result.findings.end() && bad->what == "wait" && bad->step) {
    why = why_too_late(session, *bad->step);
    return false;
  }
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
