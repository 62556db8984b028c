#include "tools/command/debugging/session_scenario.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "interpreter/base/file_path.hpp"
#include "tools/host/interruption.hpp"
#include "tools/plan/reading/system_reader.hpp"
#include "tools/scenario/reading/reader.hpp"
#include "tools/scenario/reporting/report.hpp"
#include "tools/scenario/runner.hpp"
#include "tools/scenario/transcripts/transcript.hpp"
#include "tools/scenario/transcripts/transcript_writer.hpp"
#include "tools/views/state/machine_text.hpp"

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

std::string done_text(const SessionSteps::Step& step) {
  if (step.mode) return *step.mode == Mode::Run ? "set_mode: run" : "set_mode: stop";
  if (!step.fault.empty()) return "fault: " + step.fault;
  if (!step.expect.empty()) return "memory: " + assignments_text(step.expect);
  if (!step.force.empty()) return "force: " + assignments_text(step.force);
  if (!step.unforce.empty()) return "unforce: " + unforce_text(step.unforce);
  return "set: " + assignments_text(step.set);
}

std::string step_text(const SessionSteps::Step& step) {
  if (step.send) return send_text(step);
  if (!step.event.empty()) return fmt::format("  - wait: until {}\n  - {}\n", exact(step.at), step.event);
  if (step.power)
    return fmt::format("  - wait: until {}\n  - power_cycle: memory {}\n", exact(step.at),
                       step.power->memory_lost ? "lost" : "kept") +
           (step.power->off == 0 ? "" : fmt::format("    power_off: {}\n", exact(step.power->off)));
  return fmt::format("  - wait: until {}\n  - {}\n", exact(step.at), done_text(step)) +
         (step.fault_of.empty() ? "" : fmt::format("    station: {}\n", in_quotes(step.fault_of))) +
         on_text(step.on, "    ");
}

std::string steps_text(const SessionSteps& session) {
  std::string text;
  for (const SessionSteps::Step& step : session.steps) text += step_text(step);
  return text + fmt::format("  - wait: until {}\n", exact(session.end));
}

/// How many steps of a scenario one of the session becomes: memory is set, and the like, after a wait.
std::size_t steps_in(const SessionSteps::Step& step) { return step.send ? 1 : 2; }

/// What of the session became that step of the scenario; nothing of the wait for its end.
std::optional<std::size_t> done_in(const SessionSteps& session, std::size_t number) {
  std::size_t first = 0;
  for (std::size_t done = 0; done < session.steps.size(); ++done) {
    first += steps_in(session.steps[done]);
    if (number < first) return done;
  }
  return {};
}

/// Why it comes too late in the scenario: an exchange goes on up to its end first.
std::string why_too_late(const SessionSteps::Step& step) {
  if (step.sent_until)
    return fmt::format(
        "the frame that came over a bridge at {}: another one or its answer was under way, and the steps of a scenario come "
        "one after the other",
        moment_text(step.at));
  if (step.send)
    return fmt::format(
        "the request of {} was sent while another one or its answer was under way, and the steps of a scenario come one "
        "after the other: 'continue' to the end of that answer before the next 'send'",
        moment_text(step.at));
  if (!step.expect.empty())
    return fmt::format(
        "what was printed or expected at {}: a request or its answer was under way, and the steps of a scenario come one "
        "after the other",
        moment_text(step.at));
  return fmt::format(
      "what was done at {} came while a request or its answer was under way, and the steps of a scenario come one after "
      "the other: do it before 'send', or after the answer and the silence that ends it",
      moment_text(step.at));
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

/// Whether anything is expected: an answer, memory, or a STOP.
bool expects_something(const SessionSteps& session) {
  const auto of_step = [](const SessionSteps::Step& step) { return step.send || !step.expect.empty(); };
  const auto of_end = [](const SessionSteps::End& end) { return end.stopped || !end.memory.empty(); };
  return std::ranges::any_of(session.steps, of_step) || std::ranges::any_of(session.ends, of_end);
}

constexpr std::string_view kNothingExpected =
    "nothing was sent, printed, expected or displayed, so it would test nothing; 'expect VW100 = 5' or 'display VW100' "
    "first says what";

/// How much earlier or later an answer may come: a program that is changed a little has another place in its scan then.
constexpr Time kTolerance = 5 * kMillisecond;

/// What options have asked for that a scenario has no word for.
std::string_view without_a_key(const DebuggeeOptions& options) {
  if (!options.rig.settings().memory.path.empty()) return "it began with the memory of --memory";
  return {};
}

/// What the line has from the start begins with the first step: nothing is sent before it. A system file says it itself.
void add_faults(SessionSteps& session, const std::vector<serial::Fault>& faults) {
  std::vector<SessionSteps::Step> first;
  for (const serial::Fault& fault : faults) first.push_back({.fault = serial::to_text(fault)});
  session.steps.insert(session.steps.begin(), first.begin(), first.end());
}

std::string input_text(const std::string& path) {
  return path.empty() ? ""
                      : fmt::format("input: {}\n", in_quotes(std::filesystem::absolute(file_path(path)).generic_string()));
}

std::string repairs_text(const Repairs& repairs) {
  return repairs.all ? "all" : fmt::format("{}", fmt::join(repairs.ids, ","));
}

/// What is recorded, and where it came from.
struct SessionSource {
  const DebuggeeOptions& options;
  const std::shared_ptr<const Program>& program;
  const SessionSteps& session;

  bool is_system() const { return is_system_file(options.program.path); }
  std::string path() const { return is_system() ? options.program.path : program->source.name; }
  std::string name() const { return file_path(path()).filename().string(); }
};

std::string scenario_text(const SessionSource& source) {
  const std::string head =
      source.is_system()
          ? fmt::format("system: {}\n", in_quotes(std::filesystem::absolute(file_path(source.path())).generic_string()))
          : fmt::format("cpu: \"{}\"\n{}", source.program->model->name, input_text(source.options.rig.settings().input));
  return fmt::format("name: {}\n{}after: 0 ms\nsteps:\n{}", in_quotes("a session with " + source.name()), head,
                     steps_text(source.session));
}

/// What the options have set comes beside what the text says.
void take_options(const SessionSource& source, Scenario& scenario) {
  const auto& [options, program, session] = source;
  const bool is_system = source.is_system();
  const ProgramSettings& rig = options.rig.settings();
  scenario.program = is_system ? "" : options.program.path;
  scenario.with = options.program.parts;
  scenario.times = options.program.times_table;
  scenario.line = options.master;
  if (!is_system) scenario.repair = repairs_text(options.program.repairs);
  if (!is_system) scenario.port = static_cast<std::uint8_t>(rig.port);
  scenario.plc = rig;
  if (!is_system) scenario.plc.system_block = program->system_block;
}

/// Trouble if the scenario cannot be read.
Result<Scenario> scenario_of(const SessionSource& source, const std::string& path) {
  ScenarioFile file = read_scenarios(scenario_text(source), path);
  if (!file.diagnostics.empty() || file.scenarios.size() != 1)
    return Trouble{file.diagnostics.empty() ? "it has no steps" : file.diagnostics.front().message};
  take_options(source, file.scenarios.front());
  return std::move(file.scenarios.front());
}

/// A scenario as it was run.
struct TriedScenario {
  std::optional<Scenario> scenario;
  ScenarioResult result{};
};

/// The first finding but for a STOP at the end, which the session says itself; null if there is none.
const Finding* bad_finding(const ScenarioResult& result) {
  const auto bad = std::ranges::find_if(result.findings, [](const Finding& f) { return f.what != "mode at the end"; });
  return bad == result.findings.end() ? nullptr : &*bad;
}

bool is_too_late(const Finding& finding) { return finding.what == "wait" || finding.what.starts_with("begin"); }

/// A scenario looks between two instructions in front of which the session stood.
std::string why_left_out(const SessionSteps::Step& step, const Finding& finding) {
  if (is_too_late(finding)) return why_too_late(step);
  return fmt::format("what was printed or expected at {}, which is different there in a scenario: {} is {}",
                     moment_text(step.at), finding.what, finding.found);
}

/// Runs the session as a scenario, and again without what came too late. Trouble if it cannot be run.
Result<TriedScenario> tried(const SessionSource& source, SessionSteps& session, const std::string& path) {
  for (;;) {
    auto scenario = scenario_of(source, path);
    if (!scenario) return scenario.trouble();
    TriedScenario trial{.scenario = *std::move(scenario)};
    trial.result = run_scenario(*trial.scenario, {.program = source.program, .stop = interruption()});
    if (interrupted()) return Trouble{std::string(interruption_text())};
    const Finding* const bad = bad_finding(trial.result);
    if (!bad || !(is_too_late(*bad) || bad->memory) || !bad->step) return trial;
    const auto late = done_in(session, *bad->step);
    if (!late) return Trouble{"it stands before the end of an answer: 'continue 1ms' first"};
    session.left_out.push_back(why_left_out(session.steps[*late], *bad));
    session.steps.erase(session.steps.begin() + static_cast<std::ptrdiff_t>(*late));
  }
}

constexpr std::string_view kNotTheSame = "as a scenario it does not run the same way";

/// In what the scenario went another way than the session; empty if in nothing.
std::string difference(const SessionSteps& session, const TriedScenario& trial) {
  const ScenarioResult& result = trial.result;
  if (const Finding* const bad = bad_finding(result))
    return fmt::format("{}: {}", kNotTheSame, finding_line(*trial.scenario, *bad));
  const auto is_of_master = [&](const Seen& seen) {
    const auto done = done_in(session, seen.step);
    return done && !session.steps[*done].sent_until;
  };
  const auto last = std::find_if(result.seen.rbegin(), result.seen.rend(), is_of_master);
  const bool other_answer =
      session.last && (last == result.seen.rend() || last->exchange.response != session.last->response);
  return other_answer ? fmt::format("{}: the last answer differs", kNotTheSame) : "";
}

/// Runs the text as it is to be written. Why it does not pass; empty if it does.
std::string why_it_fails(const std::string& text, const std::string& path, const std::shared_ptr<const Program>& program) {
  const ScenarioFile file = read_scenarios(text, path);
  if (!file.diagnostics.empty()) return file.diagnostics.front().message;
  const ScenarioResult result = run_scenario(file.scenarios.front(), {.program = program, .stop = interruption()});
  if (result.findings.empty()) return {};
  return fmt::format("{}: {}", kNotTheSame, finding_line(file.scenarios.front(), result.findings.front()));
}

}  // namespace

Result<> write_session_scenario(const DebuggeeOptions& options, const std::shared_ptr<const Program>& program,
                                SessionSteps& session, const FilePlace& to) {
  if (!expects_something(session)) return Trouble{std::string(kNothingExpected)};
  if (const std::string_view why = without_a_key(options); !why.empty()) return Trouble{std::string(why)};
  add_faults(session, options.rig.settings().faults);
  const SessionSource source{options, program, session};
  auto trial = tried(source, session, to.path);
  if (!trial) return trial.trouble();
  if (std::string why = session.left_out.empty() ? difference(session, *trial) : ""; !why.empty())
    return Trouble{std::move(why)};
  const Report report{&*trial->scenario, std::move(trial->result)};
  const std::string steps = transcript_text({report}, {.path = to.path,
                                                       .recorded_from = source.name(),
                                                       .tolerance = kTolerance,
                                                       .memory = true,
                                                       .by = "s7200 debug, record"});
  const std::string text = steps + end_text(session);
  std::string why = why_not_replayed(text.size());
  if (why.empty()) why = why_it_fails(text, to.path, program);
  if (interrupted()) why = interruption_text();
  if (!why.empty() && !session.left_out.empty() && !interrupted()) {
    session.left_out.push_back("how it stands at the end, which is another without the rest: " + why);
    return to.write(steps);
  }
  if (!why.empty()) return Trouble{std::move(why)};
  return to.write(text);
}

}  // namespace s7200::tools
