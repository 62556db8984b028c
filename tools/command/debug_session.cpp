#include "tools/command/debug_session.hpp"

#include <fmt/format.h>

#include "tools/command/session_scenario.hpp"
#include "tools/command/terminal.hpp"
#include "tools/host/interruption.hpp"
#include "tools/views/machine_text.hpp"

namespace s7200::tools {
namespace {

/// The step of a scenario for an action; nothing, and `why`, if there is none.
struct StepOf {
  Time at;
  std::string& why;

  SessionSteps::Step operator()(const SetMemory& set) const { return {.at = at, .set = set.assignments}; }
  SessionSteps::Step operator()(const SendFrame& send) const { return {.at = at, .send = send.request}; }
  SessionSteps::Step operator()(const serial::HostCall&) const { return refuse("characters came over a bridge"); }
  SessionSteps::Step operator()(const Jump&) const { return refuse("the program was made to go on elsewhere"); }
  SessionSteps::Step operator()(const InjectFault& inject) const {
    return {.at = at, .fault = inject.fault ? serial::to_text(*inject.fault) : "none"};
  }
  SessionSteps::Step operator()(const SetStack&) const { return refuse("the logic stack was set"); }
  SessionSteps::Step operator()(const Force&) const { return refuse("values were forced"); }
  SessionSteps::Step operator()(const Unforce&) const { return {}; }

  SessionSteps::Step refuse(std::string_view what) const {
    why = fmt::format("{} at {}, for which scenarios have no step", what, moment_text(at));
    return {};
  }
};

std::optional<SessionSteps> steps_of(const SessionRecord& record, std::string& why) {
  SessionSteps steps{.end = record.session.now.time,
                     .memory = record.memory,
                     .stopped = record.stopped,
                     .fatal_code = record.fatal_code,
                     .last = record.last};
  for (std::size_t i = 0; i < record.session.actions.size() && why.empty(); ++i) {
    auto step = std::visit(StepOf{record.session.moments[i].time, why}, record.session.actions[i]);
    if (step.send || !step.set.empty() || !step.fault.empty()) steps.steps.push_back(std::move(step));
  }
  if (record.session.memory) why = "power was switched off, from where times count anew: record it before";
  return why.empty() ? std::optional(steps) : std::nullopt;
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
          .write_scenario =
              [&options, program](const SessionRecord& record, const Destination& to, std::string& why) {
                const auto steps = steps_of(record, why);
                return steps && write_session_scenario(options, program, *steps, to, why);
              },
          .scenario_beginning = session_scenario_beginning()};
}

}  // namespace s7200::tools
