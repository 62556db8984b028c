#include "tools/command/debugging/debug_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "interpreter/base/result.hpp"
#include "tools/command/debugging/session_scenario.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/host/interruption.hpp"
#include "tools/plan/plc_keys.hpp"
#include "tools/session/past/actions/host_frames.hpp"
#include "tools/session/past/digest.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools {
namespace {

/// The step of a scenario for an action. One that does nothing is done in another way.
struct StepOf {
  using Step = SessionSteps::Step;

  Time at;

  Result<Step> operator()(const SetMemory& set) const { return Step{.at = at, .set = set.assignments}; }
  Result<Step> operator()(const SendFrame& send) const { return Step{.at = at, .send = send.request}; }
  Result<Step> operator()(const CancelRequest&) const { return Step{}; }
  Result<Step> operator()(const SetPower&) const { return Step{}; }
  Result<Step> operator()(const serial::HostCall&) const { return Step{}; }
  Result<Step> operator()(const SystemEvent& event) const { return refuse(event.words); }
  Result<Step> operator()(const Jump&) const { return refuse("the program was made to go on elsewhere"); }
  Result<Step> operator()(const InjectFault& inject) const {
    return Step{.at = at, .fault = inject.fault ? serial::to_text(*inject.fault) : "none", .fault_of = inject.of};
  }
  Result<Step> operator()(const SetMode& set) const { return Step{.at = at, .mode = set.mode}; }
  Result<Step> operator()(const SetStack&) const { return refuse("the logic stack was set"); }
  Result<Step> operator()(const Force& force) const { return Step{.at = at, .force = force.assignments}; }
  Result<Step> operator()(const Unforce& unforce) const { return Step{.at = at, .unforce = unforce.places}; }

  Trouble refuse(std::string_view what) const {
    return trouble("{} at {}, for which scenarios have no step", what, moment_text(at));
  }
};

using Places = std::vector<RigOptions::Station>;

/// What was done in a session, step by step. What no step can do is left out, and said.
class StepsOfSession {
 public:
  /// `places`: the stations as scenarios name them; none of the only PLC. `hosts`: by host port, a station on its line.
  StepsOfSession(const Places& places, const std::vector<std::optional<std::size_t>>& hosts)
      : places_(places), hosts_(hosts) {}

  /// Up to its `now`; first what was done before power went off and came back.
  void add(const Recording& recording) {
    if (recording.power) {
      const auto& [before, ram_lost, off] = *recording.power;
      add(before);
      steps_.push_back({.at = before.now.time, .power = SessionSteps::PowerCycle{ram_lost, off}});
      if (!places_.empty()) fail("power was switched off and on, for which scenarios of a system have no step");
    } else if (!recording.memory.empty()) {
      fail("it was loaded after power had been switched off, and what was before that is not in the file");
    }
    if (!recording.complete) fail("what came over a bridge before power was switched off is forgotten");
    cut_until_.clear();
    const std::size_t first = steps_.size();
    power_ups_.push_back(first);
    std::vector<HostFrames> from_hosts(hosts_.size());
    for (std::size_t i = 0; i < recording.now.actions; ++i) {
      const Action& action = recording.actions[i];
      if (const auto* const call = std::get_if<serial::HostCall>(&action))
        from_hosts.at(recording.stations[i]).note(*call, recording.moments[i].time);
      else
        add(action, i, recording.stations[i], recording.moments[i].time);
    }
    for (std::size_t host = 0; host < hosts_.size(); ++host)
      for (const HostTransmission& sent : from_hosts[host].transmissions()) add(sent, host, first);
    limit_waiting(first, recording.now.time);
  }

  /// Memory that was looked at is expected to be so again, after all that was done by then. A request that was sent at that
  /// instant has changed nothing, and its answer would come before the step after it: it is expected in front of that.
  void expect(std::size_t power_up, const SessionRecord::LookedAt& one) {
    const auto begin = steps_.begin() + static_cast<std::ptrdiff_t>(power_ups_[power_up]);
    const auto end = power_up + 1 == power_ups_.size()
                         ? steps_.end()
                         : std::prev(steps_.begin() + static_cast<std::ptrdiff_t>(power_ups_[power_up + 1]));
    auto later = std::find_if(begin, end, [&](const SessionSteps::Step& step) {
      return step.at > one.at || (step.at == one.at && step.action >= one.actions);
    });
    while (later != begin && std::prev(later)->send && std::prev(later)->at == one.at) --later;
    steps_.insert(later, {.at = one.at, .expect = one.memory, .on = place(one.station)});
    for (std::size_t next = power_up + 1; next < power_ups_.size(); ++next) ++power_ups_[next];
  }

  /// Why nothing of the session can be recorded; empty if something can.
  const std::string& why_nothing() const { return why_nothing_; }

  std::vector<SessionSteps::Step> take() { return std::move(steps_); }
  std::vector<std::string> left_out() { return std::move(left_out_); }

  std::string place(std::size_t station) const { return places_.empty() ? std::string() : places_[station].place; }

 private:
  using Steps = std::vector<SessionSteps::Step>;

  void fail(std::string why) {
    if (why_nothing_.empty()) why_nothing_ = std::move(why);
  }

  void add(const Action& action, std::size_t number, std::size_t station, Time at) {
    auto made = std::visit(StepOf{at}, action);
    if (!made) return left_out_.push_back(made.why());
    SessionSteps::Step step = *std::move(made);
    step.on = place(station);
    if (const auto* const cancel = std::get_if<CancelRequest>(&action)) return cut_short(*cancel, step.on, at);
    const auto* const power = std::get_if<SetPower>(&action);
    if (power && places_.empty())
      return fail(
          fmt::format("power was switched {} at {} while time went on, for which scenarios of one program have no "
                      "step: 'power TIME' switches it off and on again",
                      power->on ? "on" : "off", moment_text(at)));
    if (power) step = {.at = at, .event = fmt::format("power_{}: {}", power->on ? "on" : "off", places_[station].name)};
    step.action = number;
    if (step.send && at < cut_until_[step.on]) return join(*step.send, step.on, at);
    if (step.does_something()) steps_.insert(place_for(step), std::move(step));
  }

  /// A master outside waits as long as it likes, and may ask again soon after the answer: the silence that is to end it is
  /// the shortest that no frame of Modbus has inside.
  void add(const HostTransmission& sent, std::size_t host, std::size_t first) {
    constexpr auto silence = [](const SerialFormat& format) { return format.character_time() * 3 / 2; };
    std::string_view why_not;
    if (!hosts_[host]) why_not = "on a line without an S7-200, where no scenario sends";
    if (sent.lacks_stop_bit) why_not = "with a character without a stop bit, which no step sends";
    if (!why_not.empty())
      return left_out_.push_back(fmt::format("the frame of {} came over a bridge {}", moment_text(sent.from), why_not));
    SessionSteps::Step step{.at = sent.from,
                            .send = serial::Request{.frame = sent.frame, .silence = silence(sent.format)},
                            .sent_until = sent.to,
                            .on = place(*hosts_[host])};
    const auto later = std::find_if(steps_.begin() + static_cast<std::ptrdiff_t>(first), steps_.end(),
                                    [&](const auto& one) { return one.at > step.at || (one.at == step.at && one.send); });
    steps_.insert(later, std::move(step));
  }

  /// The scenario waits for an answer to what came over a bridge until the next thing was done, and no longer.
  void limit_waiting(std::size_t first, Time end) {
    constexpr Time kAtOnce = 1;
    for (std::size_t i = first; i < steps_.size(); ++i) {
      SessionSteps::Step& step = steps_[i];
      const Time next = i + 1 < steps_.size() ? steps_[i + 1].at : end;
      if (step.sent_until)
        step.timeout = std::clamp(next - std::min(next, *step.sent_until), kAtOnce, serial::Request{}.timeout);
    }
  }

  /// What was done at the instant of a request is the same in front of it, where no step is in the way.
  Steps::iterator place_for(const SessionSteps::Step& step) {
    auto place = steps_.end();
    while (!step.send && place != steps_.begin() && std::prev(place)->send && std::prev(place)->at == step.at) --place;
    return place;
  }

  /// The last that sends something there.
  Steps::reverse_iterator last_sent(const std::string& on) {
    return std::find_if(steps_.rbegin(), steps_.rend(), [&](const auto& one) { return one.send && one.on == on; });
  }

  /// What remains to be sent of a request that was given up.
  void cut_short(const CancelRequest& cancel, const std::string& on, Time at) {
    constexpr Time kAtOnce = 1;
    const auto sent = last_sent(on);
    if (cancel.answering || sent == steps_.rend())
      return left_out_.push_back(fmt::format(
          "a request was given up within its answer at {}, for which scenarios have no step: 'at {}', 'fork' and "
          "'continue' lead to the end of that answer; then record",
          moment_text(at), moment_text(at - kMicrosecond)));
    cut_until_[on] = cancel.sent_until;
    sent->send->frame.resize(cancel.sent);
    sent->timeout = std::max(cancel.waited, kAtOnce);
    if (cancel.sent == 0) steps_.erase(std::next(sent).base());
  }

  /// A request that was sent while the last character of one that was given up was on the line begins right after it: on the
  /// line they are one.
  void join(const serial::Request& next, const std::string& on, Time at) {
    SessionSteps::Step& cut = *last_sent(on);
    if (cut.send->gap != 0)
      return left_out_.push_back(fmt::format(
          "a frame was sent at {} while the last character of one that was given up was on the line, which no step "
          "can do with gaps between characters: 'continue 20ms' before 'send'",
          moment_text(at)));
    cut.send->frame.insert(cut.send->frame.end(), next.frame.begin(), next.frame.end());
    cut.timeout.reset();
    cut_until_.erase(on);
  }

  const Places& places_;
  const std::vector<std::optional<std::size_t>>& hosts_;
  std::string why_nothing_;
  std::vector<std::string> left_out_{};
  Steps steps_{};
  std::vector<std::size_t> power_ups_{};     // the first step after each
  std::map<std::string, Time> cut_until_{};  // by place, the end of the last character of a request that was given up
};

Result<SessionSteps> steps_of(const SessionRecord& record, const Places& places) {
  SessionSteps session{.steps = {}, .end = record.session.now.time, .ends = {}, .last = record.last};
  StepsOfSession steps(places, record.host_stations);
  steps.add(record.session);
  if (!steps.why_nothing().empty()) return Trouble{steps.why_nothing()};
  for (std::size_t i = 0; i < record.stations.size(); ++i) {
    const SessionRecord::Station& station = record.stations[i];
    session.ends.push_back({steps.place(i), station.memory, station.stopped, station.fatal_code});
  }
  for (std::size_t power_up = 0; power_up < record.looked_at.size(); ++power_up)
    for (const SessionRecord::LookedAt& one : record.looked_at[power_up]) steps.expect(power_up, one);
  session.steps = steps.take();
  session.left_out = steps.left_out();
  return session;
}

std::string joined_or_none(const std::vector<std::string>& texts) {
  return texts.empty() ? "none" : fmt::format("{}", fmt::join(texts, "; "));
}

/// Of the plant. How a master talks the debugger knows itself.
std::vector<SessionOption> conditions(const ProgramSettings& settings, const PlcPlan& plc) {
  std::vector<std::string> faults, assignments;
  for (const serial::Fault& fault : settings.faults) faults.push_back(serial::to_text(fault));
  for (const Assignment& one : settings.set) assignments.push_back(fmt::format("{}={}", one.place.name_of(0), one.value));
  std::vector<SessionOption> all{{"--port", fmt::format("{}", settings.port)},
                                 {"--fault", joined_or_none(faults)},
                                 {"--set", joined_or_none(assignments)},
                                 {"--input", settings.input.empty() ? "none" : "with digest " + digest_of(plc.field)}};
  for (const PlcKey& key : plc_keys()) {
    if (!key.is_option() || !key.text || key.stage != PlcKey::Stage::Program || key.shape != PlcKey::Shape::Value) continue;
    const std::string text = key.text(settings);
    if (key.name != "clock")
      all.push_back({option_of(key.name), text.empty() ? "none" : text});  // the clock of the CPU counts
  }
  return all;
}

/// In one line of the terminal, which the next output begins.
void show_progress(std::string_view text) {
  constexpr int kColumns = 60;
  fmt::print(stderr, "\r{:<{}}\r{}", "", kColumns, text);
}

}  // namespace

SessionSetup session_setup(const DebuggeeOptions& options, const Rig& rig, DebuggeeRun& live, const SessionFiles* files) {
  std::vector<DebuggedStation> stations;
  for (const RigOptions::Station& station : options.rig.named_stations(options.master))
    stations.push_back({station.name, station.master});
  return {
      .master = options.master,
      .stations = std::move(stations),
      .station = options.rig.first_station(),
      .take_failure = [&live] { return live.take_failure(); },
      .records = options.rig.recorded_files(),
      .files = files,
      .options = conditions(options.rig.settings(), rig.plan().plcs.front()),
      .write_scenario = [&options](const SessionRecord& record, const FilePlace& to) -> Result<std::vector<std::string>> {
        auto steps = steps_of(record, options.rig.named_stations(options.master));
        if (!steps) return steps.trouble();
        const auto done = write_session_scenario(options, options.rig.program(), *steps, to);
        if (!done) return done.trouble();
        return steps->left_out;
      }};
}

PromptSettings prompt_settings(SessionSetup setup, std::atomic<bool>* pause) {
  setup.stop_request = interruption();
  setup.interruption = [] { return std::string(interruption_text()); };
  setup.width = output_width();
  return {.session = std::move(setup),
          .pause = pause,
          .colour = colour_wanted(stdout),
          .progress = can_redraw(stderr) ? show_progress : std::function<void(std::string_view)>()};
}

}  // namespace s7200::tools
