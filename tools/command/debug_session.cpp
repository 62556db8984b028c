#include "tools/command/debug_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "tools/command/terminal.hpp"
#include "tools/host/interruption.hpp"
#include "tools/scenario/reader.hpp"
#include "tools/scenario/runner.hpp"
#include "tools/scenario/transcript.hpp"
#include "tools/scenario/transcript_writer.hpp"
#include "tools/views/machine_text.hpp"

namespace s7200::tools {
namespace {

/// A step of the scenario for each action; nothing, and `why`, if there is none for it.
struct StepWriter {
  Time at;
  std::string& why;

  std::string operator()(const SetMemory& set) const {
    if (set.assignments.empty()) return {};
    return fmt::format("  - wait: until {}\n  - set: {}\n", exact(at), assignments_text(set.assignments));
  }
  std::string operator()(const SendFrame& send) const {
    const serial::Request& request = send.request;
    std::string text = fmt::format("  - send: {}\n    at: {}\n", serial::to_hex(request.frame), exact(at));
    if (request.gap != 0) text += fmt::format("    gap: {}\n", exact(request.gap));
    if (request.silence) text += fmt::format("    listen: {}\n", exact(*request.silence));
    return text;
  }
  std::string operator()(const serial::HostCall&) const { return refuse("characters came over a bridge"); }
  std::string operator()(const Force&) const { return refuse("values were forced"); }
  std::string operator()(const Unforce&) const { return {}; }

  std::string refuse(std::string_view what) const {
    why = fmt::format("{} at {}, for which scenarios have no step", what, moment_text(at));
    return {};
  }
};

std::string steps_text(const SessionRecord& record, std::string& why) {
  std::string text;
  for (std::size_t i = 0; i < record.session.actions.size() && why.empty(); ++i)
    text += std::visit(StepWriter{record.session.moments[i].time, why}, record.session.actions[i]);
  const bool ends_with_exchange =
      !record.session.actions.empty() && std::holds_alternative<SendFrame>(record.session.actions.back());
  if (!ends_with_exchange || record.last) text += fmt::format("  - wait: until {}\n", exact(record.session.now.time));
  return text;
}

/// What holds at the end, in the form of a transcript.
std::string end_text(const SessionRecord& record) {
  std::string text;
  if (!record.memory.empty()) text += fmt::format("      - memory: {}\n", assignments_text(record.memory));
  if (record.fatal_code != 0)
    text += fmt::format("      - fatal: \"{:04X}\"\n", record.fatal_code);
  else if (record.stopped)
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

/// Writes it. False, and why not, if no scenario can do what was done.
bool write_session_scenario(const DebugOptions& options, const std::shared_ptr<const Program>& program,
                            const SessionRecord& record, const Destination& to, std::string& why) {
  why = without_a_key(options);
  if (record.session.memory) why = "power was switched off, from where times count anew: record it before";
  const std::string steps = why.empty() ? steps_text(record, why) : "";
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
  if (record.last && (report.result.seen.empty() || report.result.seen.back().exchange.response != record.last->response)) {
    why = "as a scenario it does not run the same way: the last answer differs";
    return false;
  }
  const std::string text =
      transcript_text({report}, {.path = to.path, .recorded_from = name, .by = "s7200 debug, record"}) + end_text(record);
  return write_result(to, text, why);
}

}  // namespace

DebuggerOptions session_options(const DebugOptions& options, const Rig& rig, const std::shared_ptr<const Program>& program,
                                const History::Settings& history) {
  return {.master = options.master,
          .stop_request = &interruption(),
          .history = history,
          .files = options.rig.recorded_files(),
          .colour = colour_wanted(stdout),
          .written = rig.files(),
          .write_scenario = [&options, program](
                                const SessionRecord& record, const Destination& to,
                                std::string& why) { return write_session_scenario(options, program, record, to, why); },
          .scenario_beginning = kTranscriptBeginning};
}

}  // namespace s7200::tools
