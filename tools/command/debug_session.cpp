#include "tools/command/debug_session.hpp"

#include <fmt/format.h>

#include "tools/command/session_scenario.hpp"
#include "tools/command/terminal.hpp"
#include "tools/debugger/digest.hpp"
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
  SessionSteps::Step operator()(const CancelRequest&) const { return {}; }
  SessionSteps::Step operator()(const SetPower&) const { return {}; }
  SessionSteps::Step operator()(const serial::HostCall&) const {
    return refuse("characters came over a bridge (a frame that 'send' puts on the line can be recorded)");
  }
  SessionSteps::Step operator()(const Jump&) const { return refuse("the program was made to go on elsewhere"); }
  SessionSteps::Step operator()(const InjectFault& inject) const {
    return {.at = at, .fault = inject.fault ? serial::to_text(*inject.fault) : "none"};
  }
  SessionSteps::Step operator()(const SetMode&) const { return refuse("the mode was changed"); }
  SessionSteps::Step operator()(const SetStack&) const { return refuse("the logic stack was set"); }
  SessionSteps::Step operator()(const Force&) const { return refuse("values were forced"); }
  SessionSteps::Step operator()(const Unforce&) const { return {}; }

  SessionSteps::Step refuse(std::string_view what) const {
    why = fmt::format("{} at {}, for which scenarios have no step", what, moment_text(at));
    return {};
  }
};

/// What remains to be sent of a request that was given up; false, and `why`, if no step can give it up there.
bool cut_short(std::vector<SessionSteps::Step>& steps, const CancelRequest& cancel, const std::string& on, Time at,
               std::string& why) {
  constexpr Time kAtOnce = 1;
  const auto sent = std::find_if(steps.rbegin(), steps.rend(), [&](const auto& one) { return one.send && one.on == on; });
  if (cancel.answering || sent == steps.rend()) {
    why = fmt::format("a request was given up within its answer at {}, for which scenarios have no step", moment_text(at));
    return false;
  }
  sent->send->frame.resize(cancel.sent);
  sent->timeout = std::max(cancel.waited, kAtOnce);
  if (cancel.sent == 0) steps.erase(std::next(sent).base());
  return true;
}

using Places = std::vector<RigOptions::Station>;

/// As scenarios name a station; nothing of the only PLC.
std::string place_in(const Places& places, std::size_t station) {
  return places.empty() ? std::string() : places[station].place;
}

/// What was done up to `now`; first what was done before power went off and came back.
void add_steps(const Recording& recording, const Places& places, std::vector<SessionSteps::Step>& steps, std::string& why) {
  if (recording.power) {
    const auto& [before, ram_lost, off] = *recording.power;
    add_steps(before, places, steps, why);
    steps.push_back({.at = before.now.time, .power = SessionSteps::PowerCycle{ram_lost, off}});
    if (!places.empty() && why.empty()) why = "power was switched off and on, for which scenarios of a system have no step";
  } else if (!recording.memory.empty() && why.empty()) {
    why = "it was loaded after power had been switched off, and what was before that is not in the file";
  }
  if (!recording.complete && why.empty()) why = "what came over a bridge before power was switched off is forgotten";
  for (std::size_t i = 0; i < recording.now.actions && why.empty(); ++i) {
    const Time at = recording.moments[i].time;
    auto step = std::visit(StepOf{at, why}, recording.actions[i]);
    if (why.empty()) step.on = place_in(places, recording.stations[i]);
    if (const auto* const cancel = std::get_if<CancelRequest>(&recording.actions[i]))
      if (!cut_short(steps, *cancel, step.on, at, why)) return;
    if (const auto* const power = std::get_if<SetPower>(&recording.actions[i]))
      step = {.at = at, .event = fmt::format("power_{}: {}", power->on ? "on" : "off", places[recording.stations[i]].name)};
    if (step.does_something()) steps.push_back(std::move(step));
  }
}

/// `places` of the stations, as scenarios name them; none of a PROGRAM.
std::optional<SessionSteps> steps_of(const SessionRecord& record, const Places& places, std::string& why) {
  SessionSteps steps{.steps = {}, .end = record.session.now.time, .ends = {}, .last = record.last};
  const auto place_of = [&](std::size_t station) { return place_in(places, station); };
  for (std::size_t i = 0; i < record.stations.size(); ++i) {
    const SessionRecord::Station& station = record.stations[i];
    steps.ends.push_back({place_of(i), station.memory, station.stopped, station.fatal_code});
  }
  add_steps(record.session, places, steps.steps, why);
  return why.empty() ? std::optional(steps) : std::nullopt;
}

std::string joined_or_none(const std::vector<std::string>& texts) {
  return texts.empty() ? "none" : fmt::format("{}", fmt::join(texts, "; "));
}

/// Of the plant. How a master talks the debugger knows itself.
std::vector<SessionOption> conditions(const RigSettings& settings, const PlcPlan& plc) {
  std::vector<std::string> faults, assignments;
  for (const serial::Fault& fault : settings.faults) faults.push_back(serial::to_text(fault));
  for (const Assignment& one : settings.set) assignments.push_back(fmt::format("{}={}", one.place.name_of(0), one.value));
  return {{"--port", fmt::format("{}", settings.port)},
          {"--fault", joined_or_none(faults)},
          {"--set", joined_or_none(assignments)},
          {"--input", settings.input.empty() ? "none" : "with digest " + digest_of(plc.field)}};
}

/// In one line of the terminal, which the next output begins.
void show_progress(std::string_view text) {
  constexpr int kColumns = 60;
  fmt::print(stderr, "\r{:<{}}\r{}", "", kColumns, text);
}

}  // namespace

DebuggerOptions session_options(const DebugOptions& options, const Rig& rig, const History::Settings& history) {
  std::vector<DebuggedStation> stations;
  for (const RigOptions::Station& station : options.rig.named_stations(options.master))
    stations.push_back({station.name, station.master});
  return {.master = options.master,
          .stations = std::move(stations),
          .station = options.rig.first_station(),
          .stop_request = &interruption(),
          .history = history,
          .files = options.rig.recorded_files(),
          .colour = colour_wanted(stdout),
          .progress = can_redraw(stderr) ? show_progress : std::function<void(std::string_view)>(),
          .written = rig.files(),
          .conditions = conditions(options.rig.settings(), rig.plan().plcs.front()),
          .write_scenario =
              [&options](const SessionRecord& record, const Destination& to, std::string& why) {
                const auto steps = steps_of(record, options.rig.named_stations(options.master), why);
                return steps && write_session_scenario(options, options.rig.program(), *steps, to, why);
              },
          .scenario_beginning = session_scenario_beginning()};
}

}  // namespace s7200::tools
