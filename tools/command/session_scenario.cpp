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
         (step.fault_of.empty() ? "" : fmt::format("    station: {}\n", in_quotes(step.fault_of))) +
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

/// Why that step of the scenario came too late: an exchange goes on up to its end first.
std::string why_too_late(const SessionSteps& session, std::size_t number) {
  std::size_t first = 0;
  for (const SessionSteps::Step& step : session.steps) {
    if (number >= first + steps_in(step)) {
      first += steps_in(step);
      continue;
    }
    if (step.send)
      return fmt::format(
          "the request of {} was sent while another one or its answer was under way, and the steps of a scenario come one "
          "after the other: 'continue' to the end of that answer before the next 'send'",
          moment_text(step.at));
    return fmt::format(
        "what was done at {} came while a request or its answer was under way, and the steps of a scenario come one after "
        "the other: do it before 'send', or after the answer and the silence that ends it",
        moment_text(step.at));
  }
  return "it stands before the end of an answer: 'continue 1ms' first";
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
  if (options.rig.faulted() && is_system_file(options.program.path)) return "a line has faults from the start";
  if (!options.rig.settings().memory.path.empty()) return "it began with the memory of --memory";
  return {};
}

/// What the line has from the start begins with the first step: nothing is sent before it.
SessionSteps with_faults(SessionSteps session, const std::vector<serial::Fault>& faults) {
  std::vector<SessionSteps::Step> first;
  for (const serial::Fault& fault : faults) first.push_back({.fault = serial::to_text(fault)});
  session.steps.insert(session.steps.begin(), first.begin(), first.end());
  return session;
}

std::string input_text(const std::string& path) {
  return path.empty() ? "" : fmt::format("input: {}\n", in_quotes(std::filesystem::absolute(path).string()));
}

std::string repairs_text(const Repairs& repairs) {
  return repairs.all ? "all" : fmt::format("{}", fmt::join(repairs.ids, ","));
}

/// What is recorded, and where it came from.
struct SessionSource {
  const DebugOptions& options;
  const std::shared_ptr<const Program>& program;
  const SessionSteps& session;

  bool is_system() const { return is_system_file(options.program.path); }
  std::string path() const { return is_system() ? options.program.path : program->source.name; }
  std::string name() const { return std::filesystem::path(path()).filename().string(); }
};

std::string scenario_text(const SessionSource& source) {
  const std::string head =
      source.is_system()
          ? fmt::format("system: {}\n", in_quotes(std::filesystem::absolute(source.path()).string()))
          : fmt::format("cpu: \"{}\"\n{}", source.program->model->name, input_text(source.options.rig.settings().input));
  return fmt::format("name: {}\n{}after: 0 ms\nsteps:\n{}", in_quotes("a session with " + source.name()), head,
                     steps_text(source.session));
}

/// What the options have set comes beside what the text says.
void take_options(const SessionSource& source, Scenario& scenario) {
  const auto& [options, program, session] = source;
  const bool is_system = source.is_system();
  const RigSettings& rig = options.rig.settings();
  scenario.program = is_system ? "" : options.program.path;
  scenario.with = options.program.parts;
  scenario.times = options.program.times_table;
  if (!is_system) scenario.system_block = program->system_block;
  scenario.line = options.master;
  if (!is_system) scenario.repair = repairs_text(options.program.repairs);
  if (!is_system) scenario.port = static_cast<std::uint8_t>(rig.port);
  scenario.set = rig.set;
  scenario.clock = rig.clock;
}

/// Nothing, and `why`, if the scenario cannot be read.
std::optional<Scenario> scenario_of(const SessionSource& source, const std::string& path, std::string& why) {
  ScenarioFile file = read_scenarios(scenario_text(source), path);
  if (!file.diagnostics.empty() || file.scenarios.size() != 1) {
    why = file.diagnostics.empty() ? "it has no steps" : file.diagnostics.front().message;
    return {};
  }
  take_options(source, file.scenarios.front());
  return std::move(file.scenarios.front());
}

/// In what the scenario went another way than the session; empty if in nothing.
std::string difference(const SessionSteps& session, const ScenarioResult& result) {
  const auto bad = std::ranges::find_if(result.findings, [](const Finding& f) { return f.what != "mode at the end"; });
  const bool too_late = bad != result.findings.end() && (bad->what == "wait" || bad->what.starts_with("begin"));
  if (too_late && bad->step) return why_too_late(session, *bad->step);
  constexpr std::string_view kNotTheSame = "as a scenario it does not run the same way";
  if (bad != result.findings.end())
    return fmt::format("{}: {}, expected {}, found {}", kNotTheSame, bad->what, bad->expected, bad->found);
  const bool other_answer =
      session.last && (result.seen.empty() || result.seen.back().exchange.response != session.last->response);
  return other_answer ? fmt::format("{}: the last answer differs", kNotTheSame) : "";
}

}  // namespace

bool write_session_scenario(const DebugOptions& options, const std::shared_ptr<const Program>& program,
                            const SessionSteps& done, const Destination& to, std::string& why) {
  why = without_a_key(options);
  if (!why.empty()) return false;
  const SessionSteps session = with_faults(done, options.rig.settings().faults);
  const SessionSource source{options, program, session};
  const std::optional<Scenario> scenario = scenario_of(source, to.path, why);
  if (!scenario) return false;
  const Report report{&*scenario, run_scenario(*scenario, {.program = program})};
  why = difference(session, report.result);
  if (!why.empty()) return false;
  const std::string text =
      transcript_text({report}, {.path = to.path, .recorded_from = source.name(), .by = "s7200 debug, record"}) +
      end_text(session);
  why = why_not_replayed(text.size());
  return why.empty() && write_result(to, text, why);
}

std::string_view session_scenario_beginning() { return kTranscriptBeginning; }

}  // namespace s7200::tools
