#include "tools/views/inspection/bounds_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "interpreter/analysis/bounds.hpp"
#include "interpreter/analysis/flow/calls.hpp"
#include "interpreter/base/text/joined.hpp"
#include "interpreter/program/loading/unread.hpp"
#include "interpreter/stl/printer.hpp"

namespace s7200::tools {
namespace {

using nlohmann::ordered_json;

constexpr std::string_view kErrors = "a program with errors has no times";
constexpr std::string_view kInterrupted = "interrupted before the bounds were known";

std::string ms(Time time) { return fmt::format("{:.3f} ms", static_cast<double>(time) / kMillisecond); }

bool has_no_times(const Inspection& inspection) {
  return inspection.has_errors || has_unread(*inspection.program) || inspection.program->times.rows().empty();
}

/// The bounds with the times of the table, and with the slowest that are possible.
struct Both {
  Bounds usual, slow;
  bool are_complete() const { return usual.is_complete && slow.is_complete; }
};

Both bounds_of(const Inspection& inspection) {
  const Calls calls = calls_of(*inspection.program, inspection.facts.flow);
  const auto slow = inspection.slowest ? inspection.slowest() : nullptr;
  const auto with = [&](const Program& timed) {
    return s7200::bounds_of(inspection.facts, calls, timed, inspection.stated_loops, inspection.waiter);
  };
  return {with(*inspection.program), with(slow ? *slow : *inspection.program)};
}

bool is_routine_wanted(const Inspection& inspection, const Routine& routine) {
  return inspection.selection.ops.empty() || std::ranges::any_of(inspection.selection.ops, [&](const Selection::Ops& each) {
           return each.first < routine.end && routine.first < each.end;
         });
}

/// `at most`, or that there is no bound and what the figure is then: `no bound; with one pass of the loop in slave.stl:552`.
std::string at_most(const Inspection& inspection, const std::vector<std::uint32_t>& loops) {
  if (loops.empty()) return "at most";
  return fmt::format("no bound; with one pass of {} in {}", loops.size() == 1 ? "the loop" : "the loops",
                     stl::joined(loops, [&](std::uint32_t op) { return line_text(inspection, op); }));
}

std::string events_in_words(const std::vector<std::uint8_t>& events) {
  const std::string all = stl::joined(events, [](std::uint8_t event) { return fmt::format("event {}", event); });
  return fmt::format("{} {}", all, events.size() == 1 ? "comes" : "come");
}

std::string slowest_text(const std::optional<Time>& time) { return time ? ms(*time) : "no bound with the slowest times"; }

std::string percent(double load) { return fmt::format("{:.0f} %", std::max(100.0, 100 * load)); }

std::string not_known_how_often(const std::vector<std::uint8_t>& events) {
  return fmt::format("how often {} is not known", events_in_words(events));
}

/// Why interrupts may have to wait for any time; nothing if they need not.
std::optional<std::string> why_disabled(const Bounds& bounds, std::string_view they) {
  if (bounds.events.empty() || !bounds.events.front().may_stay_disabled) return {};
  if (bounds.enabled_late)
    return fmt::format("{} may come before the program executes ENI, and nothing says how long before", they);
  return fmt::format("{} may stay disabled for any time", they);
}

/// Nothing if there is a bound, here and below.
std::optional<std::string> why_no_scan_with_interrupts(const Bounds& bounds) {
  if (bounds.scan_with_interrupts) return {};
  if (const auto disabled = why_disabled(bounds, "they")) return disabled;
  std::vector<std::uint8_t> unknown;
  for (const Bounds::OfEvent& event : bounds.events)
    if (!event.period) unknown.push_back(event.event);
  return unknown.empty() ? fmt::format("they can need {} of the time", percent(bounds.load)) : not_known_how_often(unknown);
}

/// `at most` where the scan alone has no loop without a bound, or the same loops and no others.
std::string interrupted_at_most(const Inspection& inspection, const Bounds& bounds) {
  const bool more = bounds.loops_of_interrupts != bounds.routines[0].loops;
  return more ? at_most(inspection, bounds.loops_of_interrupts) : "";
}

std::string scan_text(const Inspection& inspection, const Both& both, const std::optional<SeenTimes>& seen) {
  std::string text = fmt::format("Scan: {} {} ({} with the slowest times)",
                                 at_most(inspection, both.usual.routines[0].loops), ms(both.usual.scan), ms(both.slow.scan));
  if (!both.usual.events.empty())
    text += both.usual.scan_with_interrupts
                ? fmt::format(", with the interrupts that can come in it {} {}", interrupted_at_most(inspection, both.usual),
                              ms(*both.usual.scan_with_interrupts))
                : ", with interrupts it has no bound: " + *why_no_scan_with_interrupts(both.usual);
  if (seen) text += fmt::format("; seen in a run of {} s: {}", seen->run / kSecond, ms(seen->scan));
  text += fmt::format("; the watchdog stops the CPU after {}", ms(inspection.program->model->watchdog));
  return wrapped_at(text, 2) + "\n";
}

std::string routines_text(const Inspection& inspection, const Both& both) {
  std::string text = "Routines, with what they call\n";
  for (std::size_t i = 0; i < both.usual.routines.size(); ++i) {
    const Routine& routine = inspection.facts.flow.routines[i];
    if (!is_routine_wanted(inspection, routine)) continue;
    const Bounds::OfRoutine& usual = both.usual.routines[i];
    const std::string figures =
        fmt::format("{} {} ({})", at_most(inspection, usual.loops), ms(usual.time), ms(both.slow.routines[i].time));
    text += "  " + column(routine_text(routine), 9) + wrapped_at(figures, 11, 11) + "\n";
  }
  return text;
}

std::optional<std::string> why_no_latency(const Bounds& bounds, const Bounds::OfEvent& event) {
  if (event.latency) return {};
  if (const auto disabled = why_disabled(bounds, "interrupts")) return disabled;
  if (event.before == std::vector{event.event}) return "as many as come before it are served first";
  if (!event.before.empty()) return not_known_how_often(event.before) + ", which is served first";
  return fmt::format(
      "the interrupts that are served up to then can need {} of the time, and those that find its queue full are lost",
      percent(event.load));
}

std::string latency_text(const Inspection& inspection, const Both& both, std::size_t number) {
  const Bounds::OfEvent &event = both.usual.events[number], &slow = both.slow.events[number];
  if (!event.latency) return ", and when it begins has no bound: " + *why_no_latency(both.usual, event);
  std::string text = fmt::format(", and begins {} {} ({}) after it", at_most(inspection, event.loops_before),
                                 ms(*event.latency), slowest_text(slow.latency));
  if (event.may_be_lost)
    text += fmt::format(", unless its queue, for {}, is full and it is lost",
                        inspection.program->model->queue_depth[static_cast<std::size_t>(find_event(event.event)->queue)]);
  return text;
}

std::string event_text(const Inspection& inspection, const Both& both, std::size_t number,
                       const std::optional<SeenTimes>& seen) {
  const Bounds::OfEvent &event = both.usual.events[number], &slow = both.slow.events[number];
  const InterruptEvent* about = find_event(event.event);
  std::string text = fmt::format("event {}: {}", event.event, about ? about->cause : "");
  text += event.period ? fmt::format("; comes again after {} at the earliest", ms(*event.period))
                       : "; how often it comes is not known";
  text += fmt::format("; its routine takes {} {} ({})", at_most(inspection, event.loops), ms(event.longest_routine),
                      ms(slow.longest_routine));
  text += latency_text(inspection, both, number);
  if (event.period && event.longest_routine > *event.period)
    text += "; the routine is longer than the time between two of them";
  const auto found = seen ? seen->events.find(event.event) : std::map<std::uint8_t, SeenTimes::OfEvent>::const_iterator{};
  if (seen && found == seen->events.end()) text += "; not seen";
  if (seen && found != seen->events.end())
    text += fmt::format("; seen: {}, after {}", ms(found->second.longest_routine), ms(found->second.latency));
  return "  " + wrapped_at(text, 4, 2) + "\n";
}

std::optional<std::string> why_no_answer_time(const Bounds& bounds, const Bounds::OfAnswer& answer) {
  if (answer.time) return {};
  if (!answer.silence_is_known)
    return "how long the program waits for silence is not known: SMB34, SMB35 or the time-out of RCV is no constant, or a timed "
           "interrupt comes again and again, of which it may count several";
  if (const auto disabled = why_disabled(bounds, "interrupts")) return disabled;
  if (!answer.of_others.empty()) return not_known_how_often(answer.of_others);
  return fmt::format("interrupts can need {} of the time", percent(bounds.load));
}

std::string answers_text(const Inspection& inspection, const Both& both) {
  std::string text;
  for (std::size_t i = 0; i < both.usual.answers.size(); ++i) {
    const Bounds::OfAnswer &answer = both.usual.answers[i], &slow = both.slow.answers[i];
    std::string line = fmt::format("port {}: from the last character of a request to the first of its answer ", answer.port);
    line += answer.time
                ? fmt::format("{} {} ({})", at_most(inspection, answer.loops), ms(*answer.time), slowest_text(slow.time))
                : "has no bound: " + *why_no_answer_time(both.usual, answer);
    text += "  " + wrapped_at(line, 4, 2) + "\n";
  }
  return text.empty() ? text : "\nAnswers, while no other character comes\n" + text;
}

std::string places_text(const Inspection& inspection, const std::vector<std::uint32_t>& ops) {
  return stl::joined(ops, [&](std::uint32_t op) { return line_text(inspection, op); });
}

/// Why nothing is known of how often a loop runs, and what to do about it; nothing of one that is never executed.
std::optional<std::string> why_open(const Inspection& inspection, const Bounds::Loop& loop) {
  using Open = Bounds::Loop::Open;
  if (loop.times || !loop.open) return {};
  const Program& program = *inspection.program;
  const auto operand = [&](std::uint32_t op, std::size_t number) {
    return stl::to_text(program.statement(op).operands[number]);
  };
  std::string why = "nothing is known that it counts down to 0 or up to a limit";
  if (*loop.open == Open::WritesItsIndex) why = "its passes write its index or its final value";
  if (*loop.open == Open::NoLimit) {
    const std::string last = operand(loop.op, 2);
    why = fmt::format("nothing in front of it limits {}", last);
    if (!loop.copied.empty())
      why += fmt::format(", a copy of {} ({})", operand(loop.copied.front(), 0), places_text(inspection, loop.copied));
    if (!loop.counted.empty()) why += fmt::format(", which is counted up in {}", places_text(inspection, loop.counted));
  }
  return fmt::format("{}; if it runs at most N times, --loop {}=N says so", why, program.statement(loop.op).position.line);
}

std::string all_loops_text(const Inspection& inspection, const Both& both) {
  std::string text;
  for (const Bounds::Loop& loop : both.usual.loops) {
    text += row_text(inspection, "  " + column(loop.times ? fmt::format("{} times", *loop.times) : "no bound", 14), loop.op);
    if (const auto why = why_open(inspection, loop)) text += "    " + wrapped_at(*why, 4, 4) + "\n";
  }
  if (text.empty()) return text;
  return "Loops; a comment `at most 8 times` at the FOR or at the JMP back gives one a bound, or --loop LINE=8\n" + text;
}

ordered_json places(const Inspection& inspection, const std::vector<std::uint32_t>& loops) {
  ordered_json all = ordered_json::array();
  for (const std::uint32_t op : loops) all.push_back(place_json(inspection, op));
  return all;
}

ordered_json time_json(const std::optional<Time>& time) { return time ? ordered_json(*time) : ordered_json(); }
ordered_json reason_json(const std::optional<std::string>& why) { return why ? ordered_json(*why) : ordered_json(); }

ordered_json events_json(const Inspection& inspection, const Both& both, const std::optional<SeenTimes>& seen) {
  ordered_json all = ordered_json::array();
  for (std::size_t i = 0; i < both.usual.events.size(); ++i) {
    const Bounds::OfEvent &event = both.usual.events[i], &slow = both.slow.events[i];
    ordered_json json{{"event", event.event}};
    json["period_ns"] = time_json(event.period);
    json["routine_ns"] = event.longest_routine;
    json["routine_slowest_ns"] = slow.longest_routine;
    json["latency_ns"] = time_json(event.latency);
    json["latency_slowest_ns"] = time_json(slow.latency);
    json["latency_reason"] = reason_json(why_no_latency(both.usual, event));
    json["latency_slowest_reason"] = reason_json(why_no_latency(both.slow, slow));
    json["may_be_lost"] = event.may_be_lost;
    json["loops_without_bound"] = places(inspection, event.loops);
    json["latency_loops_without_bound"] = places(inspection, event.loops_before);
    const bool was_seen = seen && seen->events.contains(event.event);
    json["seen_routine_ns"] = was_seen ? ordered_json(seen->events.at(event.event).longest_routine) : ordered_json();
    json["seen_latency_ns"] = was_seen ? ordered_json(seen->events.at(event.event).latency) : ordered_json();
    all.push_back(std::move(json));
  }
  return all;
}

ordered_json answers_json(const Inspection& inspection, const Both& both) {
  ordered_json all = ordered_json::array();
  for (std::size_t i = 0; i < both.usual.answers.size(); ++i) {
    const Bounds::OfAnswer &answer = both.usual.answers[i], &slow = both.slow.answers[i];
    all.push_back({{"port", answer.port},
                   {"time_ns", time_json(answer.time)},
                   {"slowest_ns", time_json(slow.time)},
                   {"reason", reason_json(why_no_answer_time(both.usual, answer))},
                   {"slowest_reason", reason_json(why_no_answer_time(both.slow, slow))},
                   {"loops_without_bound", places(inspection, answer.loops)}});
  }
  return all;
}

std::optional<SeenTimes> seen_in(const Inspection& inspection) {
  return inspection.see_times ? inspection.see_times(inspection) : std::nullopt;
}

}  // namespace

std::string bounds_text(const Inspection& inspection) {
  if (has_no_times(inspection)) return std::string(kErrors) + "\n";
  const Both both = bounds_of(inspection);
  if (!both.are_complete()) {
    const std::string known = all_loops_text(inspection, both);
    return fmt::format("{}\n{}{}", kInterrupted, known.empty() ? "" : "\n", known);
  }
  if (!inspection.selection.everything()) return routines_text(inspection, both);
  const auto seen = seen_in(inspection);
  std::string text = scan_text(inspection, both, seen) + "\n" + routines_text(inspection, both);
  if (!both.usual.events.empty()) text += "\nInterrupts\n";
  for (std::size_t i = 0; i < both.usual.events.size(); ++i) text += event_text(inspection, both, i, seen);
  text += answers_text(inspection, both);
  const std::string loops = all_loops_text(inspection, both);
  return text + (loops.empty() ? "" : "\n" + loops);
}

ordered_json bounds_json(const Inspection& inspection) {
  if (has_no_times(inspection)) return {{"reason", kErrors}};
  const Both both = bounds_of(inspection);
  if (!both.are_complete()) return {{"reason", kInterrupted}};
  const auto seen = seen_in(inspection);
  ordered_json json{{"reason", nullptr}, {"scan_ns", both.usual.scan}, {"scan_slowest_ns", both.slow.scan}};
  json["scan_with_interrupts_ns"] = time_json(both.usual.scan_with_interrupts);
  json["scan_with_interrupts_loops_without_bound"] = places(inspection, both.usual.loops_of_interrupts);
  json["scan_with_interrupts_reason"] = reason_json(why_no_scan_with_interrupts(both.usual));
  json["seen_scan_ns"] = seen ? ordered_json(seen->scan) : ordered_json();
  json["watchdog_ns"] = inspection.program->model->watchdog;
  json["routines"] = ordered_json::array();
  for (std::size_t i = 0; i < both.usual.routines.size(); ++i)
    if (is_routine_wanted(inspection, inspection.facts.flow.routines[i]))
      json["routines"].push_back({{"routine", routine_text(inspection.facts.flow.routines[i])},
                                  {"time_ns", both.usual.routines[i].time},
                                  {"slowest_ns", both.slow.routines[i].time},
                                  {"loops_without_bound", places(inspection, both.usual.routines[i].loops)}});
  json["events"] = events_json(inspection, both, seen);
  json["answers"] = answers_json(inspection, both);
  json["loops"] = ordered_json::array();
  for (const Bounds::Loop& loop : both.usual.loops)
    json["loops"].push_back({{"times", loop.times ? ordered_json(*loop.times) : ordered_json()},
                             {"reason", reason_json(why_open(inspection, loop))},
                             {"place", place_json(inspection, loop.op)}});
  return json;
}

}  // namespace s7200::tools
