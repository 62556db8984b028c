// Running, forwards and backwards, and what is said when it stops.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "interpreter/base/text/text.hpp"
#include "interpreter/model/errors.hpp"
#include "interpreter/trace/text/statement_text.hpp"
#include "interpreter/trace/text/text_trace.hpp"
#include "tools/faces/dap/addresses.hpp"
#include "tools/faces/dap/requests.hpp"
#include "tools/faces/dap/wire/conversation.hpp"
#include "tools/session/causes/line/two_masters.hpp"
#include "tools/session/causes/writer.hpp"
#include "tools/session/commands/running.hpp"
#include "tools/session/past/past_words.hpp"
#include "tools/session/stops/goals.hpp"
#include "tools/session/stops/stop_words.hpp"
#include "tools/session/words/bad_pointers.hpp"
#include "tools/views/report.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools::dap {
namespace {

/// Of a step of the only PLC while it has no power.
constexpr Time kStepWithoutPower = 100 * kMillisecond;

std::uint64_t count_in(const Json& arguments) {
  const auto count = number_at<std::int64_t>(arguments, "count", kWhole<std::int64_t>, 1);
  if (count < 1) throw Refused("count must be a number above 0");
  return static_cast<std::uint64_t>(count);
}

Json go_on(Conversation& talk, const Json&) {
  run_to(talk, goal::none(), "");
  return {{"allThreadsContinued", true}};
}

/// Without a granularity a step is what the launch says: a line, or a network.
bool by_networks(Conversation& talk, const Json& arguments) {
  const Json* const wanted = member(arguments, "granularity");
  if (!wanted) return talk.begun.steps_are_networks;
  if (*wanted != "statement" && *wanted != "line" && *wanted != "instruction")
    throw Refused(fmt::format("granularity: {} is not statement, line or instruction", shown(*wanted)));
  return *wanted == "statement";
}

Json next(Conversation& talk, const Json& arguments) {
  const State& now = talk.cpu().state();
  run_to(talk, by_networks(talk, arguments) ? goal::network_over(now, talk.listing()) : goal::over(now), "step");
  return {};
}

Json step_in(Conversation& talk, const Json& arguments) {
  run_to(talk, by_networks(talk, arguments) ? goal::network_into(talk.listing()) : goal::instructions(1), "step");
  return {};
}

Json step_out(Conversation& talk, const Json&) {
  if (!goal::is_in_routine(talk.cpu().state()))
    throw Refused("this is the main program, in no subroutine and no interrupt routine; stepScan goes to the next scan");
  run_to(talk, goal::out(talk.cpu().state()), "step");
  return {};
}

Json step_scan(Conversation& talk, const Json& arguments) {
  run_to(talk, goal::scan(talk.cpu().state(), count_in(arguments)), "step");
  return {};
}

Json step_interrupt(Conversation& talk, const Json& arguments) {
  run_to(talk,
         truth_at(arguments, "end", false) ? goal::interrupt_ends(talk.cpu().state())
                                           : goal::interrupt_begins(talk.cpu().program()),
         "step");
  return {};
}

Json pause(Conversation& talk, const Json&) {
  if (talk.runs()) talk.pause_asked = true;
  return {};
}

/// Puts the next frame of the launch on the line. False if there is none, or not yet.
bool send_what_is_due(Conversation& talk) {
  const std::size_t first = talk.session->setup.station;
  serial::Simulation& there = talk.debuggee->history().station(first);
  if (talk.frames_sent.size() == talk.begun.frames.size() || talk.debuggee->history().in_the_past() ||
      there.master().busy() || there.time() < talk.begun.send_after || !there.plc().executes())
    return false;
  const serial::MasterSettings& master = talk.session->master(first);
  const serial::Frame& frame = talk.begun.frames[talk.frames_sent.size()];
  talk.frames_sent.push_back(there.time());
  talk.debuggee->history().act(SendFrame{master.over(there.port_format()), master.request(frame)}, first);
  return true;
}

/// With progress, if it takes long.
Stop searched_back(Conversation& talk, const Stepper::Goal& goal, std::uint64_t count) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point since = Clock::now();
  const Time start = talk.simulation().time();
  const std::string id = fmt::format("back {}", talk.handling);
  bool shown = false;
  talk.session->stepper.on_search = [&](Time from) {
    if (!talk.client.shows_progress || Clock::now() - since < talk.settings.patience) return;
    const double share =
        start == 0 ? 100 : 100.0 * static_cast<double>(start - std::min(from, start)) / static_cast<double>(start);
    Json body{{"progressId", id}, {"message", "at " + moment_text(from)}, {"percentage", static_cast<int>(share)}};
    if (!shown) body.update({{"title", "Going back in time"}, {"requestId", talk.handling}, {"cancellable", true}});
    talk.send_event(shown ? "progressUpdate" : "progressStart", std::move(body));
    shown = true;
  };
  const Stop stop = talk.session->stepper.run_back(goal, count, false);
  talk.session->stepper.on_search = [](Time) {};
  if (shown) talk.send_event("progressEnd", {{"progressId", id}});
  return stop;
}

void report_error(Conversation& talk, std::size_t station, const TraceRecord& error) {
  const LookAt look(talk, station);
  talk.print(talk.said_of(station) + describe(error, talk.cpu().program()), "important", error.op);
  if (error.op == kNoRoutine) return;
  for (const MemoryRange& pointer : bad_pointers(talk.cpu(), error.op))
    talk.print(text_of_bad_pointer(talk, "*" + pointer.name_of(0), pointer));
}

void show_the_past(Conversation& talk) {
  const History& history = talk.debuggee->history();
  if (history.in_the_past())
    talk.print(fmt::format("in the past, at {}; going forward plays what has run, up to {}",
                           moment_text(talk.simulation().time()), moment_text(history.newest().time)));
}

void report_stopped(Conversation& talk, Json body) {
  body["threadId"] = talk.thread();
  body["allThreadsStopped"] = true;
  show_the_past(talk);
  talk.send_event("stopped", std::move(body));
  report_memory_changes(talk);
}

/// `run-time error 0006`, whichever codes its filter has.
std::string exception_of(const Hit& hit) {
  if (hit.stop.on != StopPoint::On::RuntimeError || hit.stop.code || !hit.record) return hit.stop.name;
  return fmt::format("{} {:04X}", hit.stop.name, hit.record->code);
}

/// As the protocol calls it.
std::string_view reason_of(StopKind kind) {
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

/// `slave: breakpoint 2: unanswered, 01 03 …, asked by pump`, `watch 3: VW20 was …, is …, by …`
std::string text_of(Conversation& talk, const Hit& hit) {
  const Program& program = talk.program_of(hit.stop.station);
  const Listing& listing = talk.session->stations[hit.stop.station].listing;
  std::string text = talk.said_of(hit.stop.station);
  const bool is_watch = hit.stop.is_watch();
  if (kind_of(talk, hit.stop.number) != StopKind::Exception)  // which the client knows by no number
    text += fmt::format("{} {}: ", is_watch ? "watch" : "breakpoint", hit.stop.number);
  text += is_watch ? value_text(hit, program) : hit.stop.name;
  if (hit.record) text += fmt::format(", {}  {}", moment_text(hit.record->at), describe(*hit.record, program));
  if (!hit.frame.empty()) text += ", " + serial::to_hex(hit.frame);
  if (hit.asker && hit.asker->kind == Asker::Kind::Send) {
    const serial::Exchange& exchange = talk.debuggee->history().station(hit.asker->number).master().exchange();
    text += ", " + serial::to_hex(serial::bytes_of(exchange.request));
  }
  if (hit.asker) {
    const bool is_named = talk.stations() > 1 && hit.asker->kind == Asker::Kind::Plc;
    const std::string by = asked_by_text(talk.debuggee->history(), *hit.asker,
                                         is_named ? talk.session->setup.stations[hit.asker->number].name : "");
    if (!by.empty()) text += ", " + by;
  }
  if (!hit.wrong.empty()) text += ", " + wrong_answer_text(hit);
  if (const std::string mixed = not_an_answer_text(talk.debuggee->history(), hit); !mixed.empty()) text += ", " + mixed;
  if (is_watch)
    text += ", by " + (hit.by ? fmt::format("{} {}", listing.routine_of(hit.by->op), describe(*hit.by, program))
                              : changer_text(talk.debuggee->history(), hit.action, hit.planned));
  return text;
}

Json body_of_hit(Conversation& talk, const Hit& hit) {
  return {
      {"reason", reason_of(kind_of(talk, hit.stop.number))}, {"description", hit.stop.name}, {"text", text_of(talk, hit)}};
}

Json body_of_hits(Conversation& talk, const Stop& stop) {
  const auto own = std::ranges::find(stop.hits, stop.station, [](const Hit& hit) { return hit.stop.station; });
  Json body = body_of_hit(talk, own == stop.hits.end() ? stop.hits.front() : *own);
  Json ids = Json::array();
  for (const Hit& hit : stop.hits) {
    talk.print(text_of(talk, hit));
    if (kind_of(talk, hit.stop.number) != StopKind::Exception)
      ids.push_back(hit.stop.number);
    else
      talk.exceptions.try_emplace(
          hit.stop.station,
          Json{{"exceptionId", exception_of(hit)}, {"description", text_of(talk, hit)}, {"breakMode", "always"}});
  }
  if (!ids.empty()) body["hitBreakpointIds"] = ids;
  return body;
}

/// Past all that it would stop for on the way. False after a stop request.
bool has_gone_back_to(Conversation& talk, std::uint32_t op) {
  return talk.session->stepper.run_back_past_stops(goal::place(op)).reason == StopReason::Goal;
}

/// With the filter it goes back to stand in front of the instruction that made the CPU stop.
Json body_of_fatal_error(Conversation& talk) {
  const State& state = talk.cpu().state();
  const auto code = state.fatal_code;
  const std::uint32_t op = state.fatal_op;
  const bool between = op == kNoRoutine;
  const std::string text = fmt::format(
      "{}the CPU went to STOP: fatal error {:04X}, {}, {}", talk.said_of(talk.looks_at()), code,
      meaning_of(FatalError{code}),
      between ? "between two scans"
              : fmt::format("in {} {}", talk.listing().routine_of(op), stl::printable(line_of(op, talk.cpu().program()))));
  talk.print(text, "important", between ? std::nullopt : std::optional(op));
  talk.exceptions[talk.looks_at()] = {
      {"exceptionId", fmt::format("fatal {:04X}", code)}, {"description", text}, {"breakMode", "always"}};
  const bool wanted = std::ranges::any_of(talk.placed, [](const auto& entry) {
    return entry.second.kind == StopKind::Exception && entry.second.wanted["filterId"] == "watchdog";
  });
  const bool stands_there = wanted && !between && has_gone_back_to(talk, op);
  return {
      {"reason", "exception"}, {"description", text}, {"text", stands_there ? text + "; it stands in front of it" : text}};
}

/// A fatal error comes before whatever else has come up with it.
Json body_of(Conversation& talk, const Stop& stop, const std::string& reason) {
  Json body = stop.hits.empty() ? Json::object() : body_of_hits(talk, stop);
  const bool stopped = stop.reason == StopReason::CpuStopped;
  if (stopped && talk.cpu().state().fatal_code != 0) body.update(body_of_fatal_error(talk));
  if (!body.empty()) return body;
  if (stopped)
    return {{"reason", "pause"},
            {"description", talk.simulation().plc().powered() ? talk.said_of(talk.looks_at()) + "the CPU is in STOP"
                                                              : without_power(talk)}};
  if (stop.reason == StopReason::Oldest) {
    const std::string text = at_oldest_text(talk.debuggee->history());
    talk.print(text);
    return {{"reason", "entry"}, {"description", text}};
  }
  return {{"reason", reason}, {"description", reason == "pause" ? "paused" : reason}};
}

void report(Conversation& talk, const Stop& stop, const std::string& reason) {
  talk.running.reset();
  talk.pause_asked = false;
  talk.session->trace.write(kNever);
  talk.session->stepper.look_at(stop.station);
  if (talk.session->first_error) report_error(talk, talk.session->first_error->station, talk.session->first_error->record);
  for (const StopPoint& one : talk.session->stepper.stops())
    if (const std::string skipped = skipped_text(one); !skipped.empty())
      talk.print(skipped + "; with the condition 'always' it stops there too");
  for (const StopPoint& one : talk.session->stepper.stops()) talk.print(unknown_text(one));
  report_stopped(talk, body_of(talk, stop, reason));
}

/// `back` in the console takes back what a request runs, too.
void remember_as(Conversation& talk, const std::string& command) {
  talk.session->command = command;
  remember(*talk.session);
  talk.session->first_error.reset();
  talk.exceptions.clear();
}

void run_back(Conversation& talk, Stepper::Goal goal, std::uint64_t count) {
  talk.after_response([&talk, goal = std::move(goal), count] {
    remember_as(talk, "step back");
    const Stop stop = searched_back(talk, goal, count);
    report(talk, stop, stop.reason == StopReason::Request ? "pause" : "step");
  });
}

Json step_back(Conversation& talk, const Json& arguments) {
  if (by_networks(talk, arguments))
    run_back(talk, goal::back_network_into(talk.listing()), count_in(arguments));
  else
    run_back(talk, goal::back_instruction(), count_in(arguments));
  return {};
}

Json reverse_continue(Conversation& talk, const Json&) {
  run_back(talk, goal::none(), 1);
  return {{"allThreadsContinued", true}};
}

Json reverse_step_over(Conversation& talk, const Json& arguments) {
  const State& now = talk.cpu().state();
  run_back(talk, by_networks(talk, arguments) ? goal::back_network_over(now, talk.listing()) : goal::back_over(now), 1);
  return {};
}

Json reverse_step_out(Conversation& talk, const Json&) {
  if (!goal::is_in_routine(talk.cpu().state()))
    throw Refused(
        "this is the main program, in no subroutine and no interrupt routine; reverseStepScan goes back to the "
        "start of its scan");
  run_back(talk, goal::back_out(talk.cpu().state()), 1);
  return {};
}

Json reverse_step_scan(Conversation& talk, const Json& arguments) {
  run_back(talk, goal::back_scan(), count_in(arguments));
  return {};
}

Json reverse_step_interrupt(Conversation& talk, const Json& arguments) {
  const Program& program = talk.cpu().program();
  run_back(talk,
           truth_at(arguments, "end", false) ? goal::back_interrupt_ends(program) : goal::back_interrupt_begins(program), 1);
  return {};
}

Json goto_targets(Conversation& talk, const Json& arguments) {
  const std::string path = talk.source_path(arguments);
  const LookAt look(talk, talk.station_with(path));
  const auto line = talk.sources().line_in(path, talk.line_of_client(talk.client_line_in(arguments)));
  const auto op = line ? talk.listing().op_from_line(*line) : std::nullopt;
  const auto here = standing_at(talk.cpu().state());
  Json targets = Json::array();
  if (!op || !here || talk.listing().routine_of(*op) != talk.listing().routine_of(*here)) return {{"targets", targets}};
  const std::int64_t id = static_cast<std::int64_t>(talk.looks_at()) * kContainersOfAStation + *op + 1;
  talk.goto_targets[id] = {talk.looks_at(), *op};
  const Json place = talk.client_place(*op);
  targets.push_back({{"id", id},
                     {"label", talk.listing().text_of(*op)},
                     {"line", place["line"]},
                     {"column", place["column"]},
                     {"instructionPointerReference", at_station(instruction_reference(*op), talk.looks_at())}});
  return {{"targets", targets}};
}

Json go_to(Conversation& talk, const Json& arguments) {
  const auto target = talk.goto_targets.find(number_at<std::int64_t>(arguments, "targetId"));
  const auto here = standing_at(talk.cpu().state());
  if (target == talk.goto_targets.end() || !here || target->second.first != talk.looks_at() ||
      talk.listing().routine_of(target->second.second) != talk.listing().routine_of(*here))
    throw Refused("goto leads only to an instruction of the routine that runs, which gotoTargets has named");
  act(talk, Jump{target->second.second});
  talk.after_response([&talk] { stopped_at(talk, "goto", "the next instruction is another one now"); });
  return {};
}

Json go_to_moment(Conversation& talk, const Json& arguments) {
  const auto time = parse_moment(text_at(arguments, "time"), talk.debuggee->history());
  if (!time) throw Refused(time.why());
  talk.after_response([&talk, to = *time] {
    go_to_parsed(talk.debuggee->history(), to);
    stopped_at(talk, "goto", fmt::format("at {}", moment_text(talk.simulation().time())));
  });
  return {};
}

/// Something outside has ended the run.
void report_failure(Conversation& talk, const Stop& stop, const std::string& failure) {
  talk.running.reset();
  talk.pause_asked = false;
  talk.session->stepper.look_at(stop.station);
  talk.print(failure, "important");
  report_stopped(talk, {{"reason", "pause"}, {"description", failure}, {"text", failure}});
}

}  // namespace

void run_to(Conversation& talk, Stepper::Goal goal, const std::string& reason) {
  const bool passes_time = talk.stations() == 1 && !talk.simulation().plc().powered() && reason == "step";
  talk.running = RunUnderWay{std::move(goal), reason, passes_time ? talk.simulation().time() + kStepWithoutPower : kNever};
  remember_as(talk, reason.empty() ? "continue" : reason);
  talk.session->show = tools::Session::Show::None;
  talk.session->unasked = 0;
  talk.session->trace.follow();
}

void stopped_at(Conversation& talk, const std::string& reason, const std::string& description) {
  talk.exceptions.clear();
  report_stopped(talk, {{"reason", reason}, {"description", description}});
}

void run_on(Conversation& talk) {
  while (talk.running) {
    if (talk.pause_asked) return report(talk, {.reason = StopReason::Request, .station = talk.looks_at()}, "pause");
    const History& history = talk.debuggee->history();
    const bool stands =
        talk.stations() == 1 && !talk.simulation().system().has_schedule() && !talk.simulation().plc().executes();
    const bool passes_time = talk.running->until != kNever;
    const bool waits = talk.simulation().has_master() && talk.simulation().master().asks();
    if (stands && !waits && !passes_time && !history.in_the_past())
      return report(talk, {.reason = StopReason::CpuStopped, .station = talk.looks_at()}, "");
    send_what_is_due(talk);
    const bool more = talk.frames_sent.size() < talk.begun.frames.size();
    const Time now = talk.simulation().time();
    Time limit = std::min(more && now < talk.begun.send_after ? talk.begun.send_after : kNever, talk.running->until);
    if (stands && !waits && !passes_time) limit = history.newest().time;
    const Stop stop = talk.session->stepper.run(talk.running->goal, limit, more || stands);
    if (const std::string failure = talk.session->setup.take_failure(); !failure.empty())
      return report_failure(talk, stop, failure);
    if (stop.reason == StopReason::Request) {
      if (!talk.pause_asked) return;
    } else if (!stop.hits.empty() || (stop.reason != StopReason::Limit && stop.reason != StopReason::Answer)) {
      return report(talk, stop, talk.running->reason);
    } else if (talk.simulation().time() >= talk.running->until) {
      return report(talk, {.reason = StopReason::Goal, .station = talk.looks_at()}, talk.running->reason);
    }
  }
}

std::vector<Request> steps_requests() {
  return {{"continue", go_on, Needs::Standstill},
          {"next", next, Needs::Standstill},
          {"stepIn", step_in, Needs::Standstill},
          {"stepOut", step_out, Needs::Standstill},
          {"stepScan", step_scan, Needs::Standstill},
          {"stepInterrupt", step_interrupt, Needs::Standstill},
          {"pause", pause},
          {"stepBack", step_back, Needs::Standstill},
          {"reverseContinue", reverse_continue, Needs::Standstill},
          {"reverseStepOver", reverse_step_over, Needs::Standstill},
          {"reverseStepOut", reverse_step_out, Needs::Standstill},
          {"reverseStepScan", reverse_step_scan, Needs::Standstill},
          {"reverseStepInterrupt", reverse_step_interrupt, Needs::Standstill},
          {"gotoTargets", goto_targets},
          {"goto", go_to, Needs::Standstill},
          {"goToMoment", go_to_moment, Needs::Standstill}};
}

}  // namespace s7200::tools::dap
