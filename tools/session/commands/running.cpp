#include "tools/session/commands/running.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>

#include "interpreter/base/text/text.hpp"
#include "tools/session/commands/answers/stop_reports.hpp"
#include "tools/session/commands/memory_words.hpp"
#include "tools/session/stops/goals.hpp"
#include "tools/session/words/words.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools {
namespace {

/// Is told what an action makes happen at once.
class Told final : public Observer {
 public:
  explicit Told(std::function<void(const TraceRecord&)> tell) : tell_(std::move(tell)) {}
  void record(const TraceRecord& record) override { tell_(record); }

 private:
  std::function<void(const TraceRecord&)> tell_;
};

constexpr std::array<std::string_view, 7> kStopWords{"goal", "stop point", "answer", "limit", "request", "CPU", "oldest"};

/// {"stopped": "limit"}: why a run has come to its end.
Json stopped_json(const Stop& stop) { return {{"stopped", kStopWords[static_cast<std::size_t>(stop.reason)]}}; }

std::uint64_t errors_of_all(const Session& session) {
  std::uint64_t errors = 0;
  for (const Session::Station& station : session.stations) errors += station.simulation->cpu().state().error_count;
  return errors;
}

/// There is nothing to step through, and what can be done.
std::string standstill_text(const Session& session) {
  const State& state = session.cpu().state();
  const bool powered = session.simulation().plc().powered();
  const std::string name = session.name_of(session.focus());
  if (session.is_system())
    return fmt::format("{} {} and executes nothing; 'continue' runs the others, 'station NAME' goes over to one of them\n",
                       name, powered ? "is in STOP" : "is without power");
  if (!powered)
    return fmt::format("{}; 'continue' lets time pass, 'rstep' and 'back' return to before that\n",
                       without_power_text(name));
  return fmt::format(
      "the CPU is in STOP and executes nothing; 'continue' lets time pass, {}, 'rstep' and 'back' return to before that\n",
      state.fatal_code == 0 ? "'mode run' starts it" : "'restart' powers it up again");
}

/// To its end, with what is asked for meanwhile. Nothing after something that has moved it, which has said where it stands.
std::optional<Stop> run_through(Session& session, const RunTo& run) {
  const Time now = session.history.now().time, end = now < kNever - run.limit ? now + run.limit : kNever;
  Stop stop = session.stepper.run(run.goal, end, run.stop_at_answer);
  while (stop.reason == StopReason::Request) {
    const std::optional<bool> goes_on = session.onlooker.carry_out_asked();
    if (!goes_on) break;
    if (!*goes_on) return {};
    stop = session.stepper.run(run.goal, end, run.stop_at_answer);
  }
  if (stop.reason != StopReason::Limit || !run.to_scan_end || !session.simulation().plc().executes()) return stop;
  return session.stepper.run(goal::scan(session.cpu().state(), 1), kNever, run.stop_at_answer);
}

}  // namespace

Reply go(Session& session, const RunTo& run) {
  if (!session.simulation().plc().executes() && !run.of_all) {
    session.said << standstill_text(session);
    return {};
  }
  remember(session);
  session.show = run.show;
  session.first_error.reset();
  session.unasked = 0;
  const std::uint64_t errors_before = errors_of_all(session);
  session.onlooker.run_begins(run.of_all);
  session.trace.follow();
  const auto stop = run_through(session, run);
  session.onlooker.run_ended();
  session.trace.write(kNever);
  if (!stop) return {};
  session.look_at(stop->station);
  report(session, *stop, run, errors_of_all(session) - errors_before);
  return {.json = stopped_json(*stop)};
}

Reply go_back(Session& session, const Stepper::Goal& goal, std::uint64_t count, bool stop_at_answer) {
  remember(session);
  session.first_error.reset();
  const Stop stop = session.stepper.run_back(goal, count, stop_at_answer);
  session.look_at(stop.station);
  session.note_going_elsewhere();
  report_hits(session, stop);
  report_reason(session, stop, {});
  for (const std::size_t asker : stop.answered)
    session.said << answer_text(session, asker, session.stations[asker].simulation->master().exchange());
  return arrive(session);
}

void go_to(Session& session, const Moment& moment) {
  remember(session);
  session.history.go_to(moment);
  arrive(session);
}

void remember(Session& session, History::Place place) {
  if (session.kept.size() == Session::kKeptStates) session.kept.pop_front();
  session.kept.push_back({session.command, std::move(place), session.focus()});
}

void act(Session& session, Action action, std::size_t station) {
  History& history = session.history;
  const bool branches = history.in_the_past();
  const Time left = history.newest().time;
  if (branches) remember(session);
  session.trace.follow();
  Told told([&](const TraceRecord& record) { session.trace.note(history.told_of(), record); });
  history.act(std::move(action), station, &told);
  session.trace.write(kNever);
  if (!branches) return;
  session.said << fmt::format("a new branch begins here; what ran up to {} is on the old one, to which 'back' returns\n",
                              moment_text(left));
  note_new_branch(session);
  session.tell("");
}

/// A record of what went on cannot go back: a capture ends, a trace says so by its times.
void note_new_branch(Session& session) {
  for (const Session::Station& station : session.stations) station.simulation->plc().unwatch_lines();
  session.stepper.count_hits();
  if (session.setup.records.empty()) return;
  session.tell(fmt::format("{}: traces go on with what is new, after what ran before; captures of the line end\n",
                           std::exchange(session.setup.records, {})));
}

void show_place(Session& session) {
  const std::size_t focus = session.focus();
  if (session.is_system()) session.said << session.name_of(focus) << "  ";
  std::string place = session.simulation().plc().powered() ? place_text(session.cpu(), session.listing())
                                                           : place_line(session, focus) + "\n";
  if (const std::size_t mark = place.find("\n > "); mark != std::string::npos) place.replace(mark + 2, 1, session.bold(">"));
  session.said << place;
  if (session.onlooker.shows_memory()) return;
  for (const auto& [station, range] : session.displayed)
    session.said << session.said_of(station) << memory_text(session, station, range);
}

Reply arrive(Session& session) {
  session.note_going_elsewhere();
  show_place(session);
  if (session.history.in_the_past())
    session.said << fmt::format("  in the past; going forward plays what has run, up to {}\n",
                                moment_text(session.history.newest().time));
  return {};
}

std::string place_line(const Session& session, std::size_t station) {
  const Session::Station& of = session.stations[station];
  if (!of.simulation->plc().powered()) return fmt::format("{}  without power", moment_text(session.history.now().time));
  const std::string place = place_text(of.simulation->cpu(), of.listing);
  return place.substr(0, place.find('\n'));
}

std::string requests_under_way(const Session& session) {
  std::vector<const serial::Requester*> masters;
  std::string text;
  for (std::size_t number = 0; number < session.stations.size(); ++number) {
    serial::Simulation& here = *session.stations[number].simulation;
    if (!here.has_master() || !here.master().asks()) continue;
    if (std::ranges::find(masters, &here.master()) != masters.end()) continue;
    masters.push_back(&here.master());
    text += (text.empty() ? "" : ", ") + session.said_of(number) + serial::to_hex(here.master().exchange().request);
  }
  return text;
}

Reply interrupted(const Session& session) { return {.text = session.setup.interruption() + "\n", .interrupted = true}; }

std::string without_power(const Session& session, std::string_view command) {
  if (session.simulation().plc().powered()) return {};
  return fmt::format("{}: {}", command, without_power_text(session.name_of(session.focus())));
}

void say_without_power(Session& session) {
  if (!session.simulation().plc().powered())
    session.said << fmt::format("{} is without power; it was:\n", session.name_of(session.focus()));
}

}  // namespace s7200::tools
