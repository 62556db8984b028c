// Running, forwards and backwards, and what is said when it stops.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "interpreter/base/text.hpp"
#include "interpreter/model/errors.hpp"
#include "interpreter/trace/text_trace.hpp"
#include "tools/faces/dap/addresses.hpp"
#include "tools/faces/dap/session.hpp"
#include "tools/session/causes/two_masters.hpp"
#include "tools/session/causes/writer.hpp"
#include "tools/session/past/past_words.hpp"
#include "tools/session/stops/goals.hpp"
#include "tools/session/stops/stop_words.hpp"
#include "tools/session/words/bad_pointers.hpp"
#include "tools/views/machine_text.hpp"
#include "tools/views/report.hpp"

namespace s7200::tools::dap {
namespace {

/// Of a step of the only PLC while it has no power.
constexpr Time kStepWithoutPower = 100 * kMillisecond;

std::uint64_t count_in(const Json& arguments) {
  const auto count = number_at<std::int64_t>(arguments, "count", kWhole<std::int64_t>, 1);
  if (count < 1) throw Refused("count must be a number above 0");
  return static_cast<std::uint64_t>(count);
}

}  // namespace

// --- forwards ---

void Session::run_to(Stepper::Goal goal, const std::string& reason) {
  const bool passes_time = stations() == 1 && !simulation().plc().powered() && reason == "step";
  running_ = Run{std::move(goal), reason, passes_time ? simulation().time() + kStepWithoutPower : kNever};
  session_->first_error.reset();
  session_->show = tools::Session::Show::None;
  session_->unasked = 0;
  session_->trace.follow();
  exceptions_.clear();
}

Json Session::go_on(const Json&) {
  run_to(goal::none(), "");
  return {{"allThreadsContinued", true}};
}

/// Without a granularity a step is what the launch says: a line, or a network.
bool Session::by_networks(const Json& arguments) const {
  const Json* const wanted = member(arguments, "granularity");
  if (!wanted) return steps_are_networks_;
  if (*wanted != "statement" && *wanted != "line" && *wanted != "instruction")
    throw Refused(fmt::format("granularity: {} is not statement, line or instruction", shown(*wanted)));
  return *wanted == "statement";
}

Json Session::next(const Json& arguments) {
  const State& now = cpu().state();
  run_to(by_networks(arguments) ? goal::network_over(now, listing()) : goal::over(now), "step");
  return {};
}

Json Session::step_in(const Json& arguments) {
  run_to(by_networks(arguments) ? goal::network_into(listing()) : goal::instructions(1), "step");
  return {};
}

Json Session::step_out(const Json&) {
  if (!goal::is_in_routine(cpu().state()))
    throw Refused("this is the main program, in no subroutine and no interrupt routine; stepScan goes to the next scan");
  run_to(goal::out(cpu().state()), "step");
  return {};
}

Json Session::step_scan(const Json& arguments) {
  run_to(goal::scan(cpu().state(), count_in(arguments)), "step");
  return {};
}

Json Session::step_interrupt(const Json& arguments) {
  run_to(truth_at(arguments, "end", false) ? goal::interrupt_ends(cpu().state()) : goal::interrupt_begins(cpu().program()),
         "step");
  return {};
}

Json Session::pause(const Json&) {
  if (runs()) pause_asked_ = true;
  return {};
}

/// Puts the next frame of the launch on the line. False if there is none, or not yet.
bool Session::send_what_is_due() {
  const std::size_t first = session_->setup.station;
  serial::Simulation& there = debuggee_->history().station(first);
  if (frames_sent_.size() == frames_.size() || debuggee_->history().in_the_past() || there.master().busy() ||
      there.time() < send_after_ || !there.plc().executes())
    return false;
  const serial::MasterSettings& master = session_->master(first);
  const serial::Frame& frame = frames_[frames_sent_.size()];
  frames_sent_.push_back(there.time());
  debuggee_->history().act(SendFrame{master.over(there.port_format()), master.request(frame)}, first);
  return true;
}

void Session::run() {
  while (running_) {
    if (pause_asked_) return report({.reason = StopReason::Request, .station = looks_at()}, "pause");
    const History& history = debuggee_->history();
    const bool stands = stations() == 1 && !simulation().system().has_schedule() && !simulation().plc().executes();
    const bool passes_time = running_->until != kNever;
    const bool waits = simulation().has_master() && simulation().master().asks();
    if (stands && !waits && !passes_time && !history.in_the_past())
      return report({.reason = StopReason::CpuStopped, .station = looks_at()}, "");
    send_what_is_due();
    const bool more = frames_sent_.size() < frames_.size();
    const Time now = simulation().time();
    Time limit = std::min(more && now < send_after_ ? send_after_ : kNever, running_->until);
    if (stands && !waits && !passes_time) limit = history.newest().time;
    const Stop stop = session_->stepper.run(running_->goal, limit, more || stands);
    if (const std::string failure = session_->setup.take_failure(); !failure.empty()) return report_failure(stop, failure);
    if (stop.reason == StopReason::Request) {
      if (!pause_asked_) return;
    } else if (!stop.hits.empty() || (stop.reason != StopReason::Limit && stop.reason != StopReason::Answer)) {
      return report(stop, running_->reason);
    } else if (simulation().time() >= running_->until) {
      return report({.reason = StopReason::Goal, .station = looks_at()}, running_->reason);
    }
  }
}

// --- backwards ---

Json Session::step_back(const Json& arguments) {
  if (by_networks(arguments))
    run_back(goal::back_network_into(listing()), count_in(arguments));
  else
    run_back(goal::back_instruction(), count_in(arguments));
  return {};
}

Json Session::reverse_continue(const Json&) {
  run_back(goal::none(), 1);
  return {{"allThreadsContinued", true}};
}

Json Session::reverse_step_over(const Json& arguments) {
  const State& now = cpu().state();
  run_back(by_networks(arguments) ? goal::back_network_over(now, listing()) : goal::back_over(now), 1);
  return {};
}

Json Session::reverse_step_out(const Json&) {
  if (!goal::is_in_routine(cpu().state()))
    throw Refused(
        "this is the main program, in no subroutine and no interrupt routine; reverseStepScan goes back to the "
        "start of its scan");
  run_back(goal::back_out(cpu().state()), 1);
  return {};
}

Json Session::reverse_step_scan(const Json& arguments) {
  run_back(goal::back_scan(), count_in(arguments));
  return {};
}

Json Session::reverse_step_interrupt(const Json& arguments) {
  const Program& program = cpu().program();
  run_back(truth_at(arguments, "end", false) ? goal::back_interrupt_ends(program) : goal::back_interrupt_begins(program), 1);
  return {};
}

void Session::run_back(Stepper::Goal goal, std::uint64_t count) {
  after_response([this, goal = std::move(goal), count] {
    session_->first_error.reset();
    exceptions_.clear();
    const Stop stop = searched_back(goal, count);
    report(stop, stop.reason == StopReason::Request ? "pause" : "step");
  });
}

/// With progress, if it takes long.
Stop Session::searched_back(const Stepper::Goal& goal, std::uint64_t count) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point since = Clock::now();
  const Time start = simulation().time();
  const std::string id = fmt::format("back {}", handling_);
  bool shown = false;
  session_->stepper.on_search = [&](Time from) {
    if (!client_shows_progress_ || Clock::now() - since < settings_.patience) return;
    const double share =
        start == 0 ? 100 : 100.0 * static_cast<double>(start - std::min(from, start)) / static_cast<double>(start);
    Json body{{"progressId", id}, {"message", "at " + moment_text(from)}, {"percentage", static_cast<int>(share)}};
    if (!shown) body.update({{"title", "Going back in time"}, {"requestId", handling_}, {"cancellable", true}});
    send_event(shown ? "progressUpdate" : "progressStart", std::move(body));
    shown = true;
  };
  const Stop stop = session_->stepper.run_back(goal, count, false);
  session_->stepper.on_search = [](Time) {};
  if (shown) send_event("progressEnd", {{"progressId", id}});
  return stop;
}

// --- elsewhere ---

Json Session::goto_targets(const Json& arguments) {
  const std::string path = source_path(arguments);
  const LookAt look(*this, station_with(path));
  const auto line = sources().line_in(path, line_of_client(client_line_in(arguments)));
  const auto op = line ? listing().op_from_line(*line) : std::nullopt;
  const auto here = standing_at(cpu().state());
  Json targets = Json::array();
  if (!op || !here || listing().routine_of(*op) != listing().routine_of(*here)) return {{"targets", targets}};
  const std::int64_t id = static_cast<std::int64_t>(looks_at()) * kContainersOfAStation + *op + 1;
  goto_targets_[id] = {looks_at(), *op};
  const Json place = client_place(*op);
  targets.push_back({{"id", id},
                     {"label", listing().text_of(*op)},
                     {"line", place["line"]},
                     {"column", place["column"]},
                     {"instructionPointerReference", at_station(instruction_reference(*op), looks_at())}});
  return {{"targets", targets}};
}

Json Session::go_to(const Json& arguments) {
  const auto target = goto_targets_.find(number_at<std::int64_t>(arguments, "targetId"));
  const auto here = standing_at(cpu().state());
  if (target == goto_targets_.end() || !here || target->second.first != looks_at() ||
      listing().routine_of(target->second.second) != listing().routine_of(*here))
    throw Refused("goto leads only to an instruction of the routine that runs, which gotoTargets has named");
  act(Jump{target->second.second});
  after_response([this] { stopped_at("goto", "the next instruction is another one now"); });
  return {};
}

Json Session::go_to_moment(const Json& arguments) {
  std::string why;
  const auto time = parse_moment(text_at(arguments, "time"), debuggee_->history(), why);
  if (!time) throw Refused(why);
  after_response([this, to = *time] {
    go_to_parsed(debuggee_->history(), to);
    stopped_at("goto", fmt::format("at {}", moment_text(simulation().time())));
  });
  return {};
}

// --- it has stopped ---

void Session::report(const Stop& stop, const std::string& reason) {
  running_.reset();
  pause_asked_ = false;
  session_->trace.write(kNever);
  session_->stepper.look_at(stop.station);
  if (session_->first_error) report_error(session_->first_error->station, session_->first_error->record);
  for (const StopPoint& one : session_->stepper.stops())
    if (const std::string skipped = skipped_text(one); !skipped.empty())
      print(skipped + "; with the condition 'always' it stops there too");
  for (const StopPoint& one : session_->stepper.stops()) print(unknown_text(one));
  report_stopped(body_of(stop, reason));
}

/// Something outside has ended the run.
void Session::report_failure(const Stop& stop, const std::string& failure) {
  running_.reset();
  pause_asked_ = false;
  session_->stepper.look_at(stop.station);
  print(failure, "important");
  report_stopped({{"reason", "pause"}, {"description", failure}, {"text", failure}});
}

void Session::report_error(std::size_t station, const TraceRecord& error) {
  const LookAt look(*this, station);
  print(said_of(station) + describe(error, cpu().program()), "important", error.op);
  if (error.op == kNoRoutine) return;
  for (const MemoryRange& pointer : bad_pointers(cpu(), error.op))
    print(text_of_bad_pointer("*" + pointer.name_of(0), pointer));
}

void Session::stopped_at(const std::string& reason, const std::string& description) {
  exceptions_.clear();
  report_stopped({{"reason", reason}, {"description", description}});
}

void Session::report_stopped(Json body) {
  body["threadId"] = thread();
  body["allThreadsStopped"] = true;
  show_the_past();
  send_event("stopped", std::move(body));
  report_memory_changes();
}

void Session::show_the_past() {
  const History& history = debuggee_->history();
  if (history.in_the_past())
    print(fmt::format("in the past, at {}; going forward plays what has run, up to {}", moment_text(simulation().time()),
                      moment_text(history.newest().time)));
}

/// A fatal error comes before whatever else has come up with it.
Json Session::body_of(const Stop& stop, const std::string& reason) {
  Json body = stop.hits.empty() ? Json::object() : body_of_hits(stop);
  const bool stopped = stop.reason == StopReason::CpuStopped;
  if (stopped && cpu().state().fatal_code != 0) body.update(body_of_fatal_error());
  if (!body.empty()) return body;
  if (stopped)
    return {{"reason", "pause"},
            {"description", simulation().plc().powered() ? said_of(looks_at()) + "the CPU is in STOP" : without_power()}};
  if (stop.reason == StopReason::Oldest) {
    const std::string text = at_oldest_text(debuggee_->history());
    print(text);
    return {{"reason", "entry"}, {"description", text}};
  }
  return {{"reason", reason}, {"description", reason == "pause" ? "paused" : reason}};
}

/// Past all that it would stop for on the way. False after a stop request.
bool Session::has_gone_back_to(std::uint32_t op) {
  return session_->stepper.run_back_past_stops(goal::place(op)).reason == StopReason::Goal;
}

/// `run-time error 0006`, whichever codes its filter has.
std::string Session::exception_of(const Hit& hit) {
  if (hit.stop.on != StopPoint::On::RuntimeError || hit.stop.code || !hit.record) return hit.stop.name;
  return fmt::format("{} {:04X}", hit.stop.name, hit.record->code);
}

Json Session::body_of_hits(const Stop& stop) {
  const auto own = std::ranges::find(stop.hits, stop.station, [](const Hit& hit) { return hit.stop.station; });
  Json body = body_of_hit(own == stop.hits.end() ? stop.hits.front() : *own);
  Json ids = Json::array();
  for (const Hit& hit : stop.hits) {
    print(text_of(hit));
    if (kind_of(hit.stop.number) != StopKind::Exception)
      ids.push_back(hit.stop.number);
    else
      exceptions_.try_emplace(
          hit.stop.station,
          Json{{"exceptionId", exception_of(hit)}, {"description", text_of(hit)}, {"breakMode", "always"}});
  }
  if (!ids.empty()) body["hitBreakpointIds"] = ids;
  return body;
}

/// As the protocol calls it.
std::string_view Session::reason_of(StopKind kind) {
  switch (kind) {
    case StopKind::Line:
      return "breakpoint";
    case StopKind::Function:
      return "function breakpoint";
    case StopKind::Data:
      return "data breakpoint";
    case StopKind::Instruction:
      return "instruction breakpoint";
    case StopKind::Exception:
      return "exception";
  }
  return {};
}

Json Session::body_of_hit(const Hit& hit) {
  return {{"reason", reason_of(kind_of(hit.stop.number))}, {"description", hit.stop.name}, {"text", text_of(hit)}};
}

/// `slave: breakpoint 2: unanswered, 01 03 …, asked by pump`, `watch 3: VW20 was …, is …, by …`
std::string Session::text_of(const Hit& hit) const {
  const Program& program = program_of(hit.stop.station);
  const Listing& listing = session_->stations[hit.stop.station].listing;
  std::string text = said_of(hit.stop.station);
  const bool is_watch = hit.stop.is_watch();
  if (kind_of(hit.stop.number) != StopKind::Exception)  // which the client knows by no number
    text += fmt::format("{} {}: ", is_watch ? "watch" : "breakpoint", hit.stop.number);
  text += is_watch ? value_text(hit, program) : hit.stop.name;
  if (hit.record) text += fmt::format(", {}  {}", moment_text(hit.record->at), describe(*hit.record, program));
  if (!hit.frame.empty()) text += ", " + serial::to_hex(hit.frame);
  if (hit.asker && hit.asker->kind == Asker::Kind::Send) {
    const serial::Exchange& exchange = debuggee_->history().station(hit.asker->number).master().exchange();
    text += ", " + serial::to_hex(serial::bytes_of(exchange.request));
  }
  if (hit.asker) {
    const bool is_named = stations() > 1 && hit.asker->kind == Asker::Kind::Plc;
    const std::string by =
        asked_by_text(debuggee_->history(), *hit.asker, is_named ? session_->setup.stations[hit.asker->number].name : "");
    if (!by.empty()) text += ", " + by;
  }
  if (!hit.wrong.empty()) text += ", " + wrong_answer_text(hit);
  if (const std::string mixed = not_an_answer_text(debuggee_->history(), hit); !mixed.empty()) text += ", " + mixed;
  if (is_watch)
    text += ", by " + (hit.by ? fmt::format("{} {}", listing.routine_of(hit.by->op), describe(*hit.by, program))
                              : changer_text(debuggee_->history(), hit.action, hit.planned));
  return text;
}

/// With the filter it goes back to stand in front of the instruction that made the CPU stop.
Json Session::body_of_fatal_error() {
  const State& state = cpu().state();
  const auto code = state.fatal_code;
  const std::uint32_t op = state.fatal_op;
  const bool between = op == kNoRoutine;
  const std::string text = fmt::format(
      "{}the CPU went to STOP: fatal error {:04X}, {}, {}", said_of(looks_at()), code, meaning_of(FatalError{code}),
      between ? "between two scans" : fmt::format("in {} line {}", listing().routine_of(op), listing().line_of(op)));
  print(text, "important", between ? std::nullopt : std::optional(op));
  exceptions_[looks_at()] = {
      {"exceptionId", fmt::format("fatal {:04X}", code)}, {"description", text}, {"breakMode", "always"}};
  const bool wanted = std::ranges::any_of(placed_, [](const auto& entry) {
    return entry.second.kind == StopKind::Exception && entry.second.wanted["filterId"] == "watchdog";
  });
  const bool stands_there = wanted && !between && has_gone_back_to(op);
  return {
      {"reason", "exception"}, {"description", text}, {"text", stands_there ? text + "; it stands in front of it" : text}};
}

}  // namespace s7200::tools::dap
