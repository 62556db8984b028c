// Back in time: the commands that go to another moment, that ask what was before, and that begin a new branch.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <ostream>

#include "interpreter/base/counted.hpp"
#include "interpreter/base/numbers.hpp"
#include "interpreter/base/text.hpp"
#include "interpreter/trace/text_trace.hpp"
#include "tools/debugger/debugger.hpp"
#include "tools/host/interruption.hpp"
#include "tools/session/causes/memory_cause.hpp"
#include "tools/session/observers/last_instructions.hpp"
#include "tools/session/observers/timeline_of_past.hpp"
#include "tools/session/past/past_words.hpp"
#include "tools/session/stops/goals.hpp"
#include "tools/session/stops/words.hpp"
#include "tools/views/execution_text.hpp"
#include "tools/views/machine_text.hpp"

namespace s7200::tools {

Debugger::Error Debugger::back(const Arguments& arguments) {
  const auto count = parse_count(arguments);
  if (!count) return expects("back", "how many commands, for example: back 2");
  if (kept_.empty()) {
    out_ << "there is no earlier state: no command has run anything, or all states kept have been used\n";
    return {};
  }
  if (*count > kept_.size())
    out_ << fmt::format("only {} {} kept\n", counted(kept_.size(), "earlier state"), kept_.size() == 1 ? "is" : "are");
  kept_.resize(kept_.size() - std::min<std::size_t>(*count, kept_.size()) + 1);
  const History::BranchPtr left = history_.here().branch;
  history_.return_to(kept_.back().place);
  out_ << fmt::format("back to before '{}'\n", stl::printable(kept_.back().command));
  stepper_.look_at(kept_.back().station);
  kept_.pop_back();
  note_going_elsewhere();
  if (history_.here().branch != left) note_new_branch();
  show_place();
  return {};
}

Debugger::Error Debugger::back_step(const Arguments& arguments) {
  const auto count = parse_count(arguments);
  if (!count) return expects("rstep", "how many instructions, for example: rstep 5");
  go_back(goal::back_instruction(), *count);
  return {};
}

Debugger::Error Debugger::back_over(const Arguments& arguments) {
  if (!arguments.empty()) return no_argument("rover");
  go_back(goal::back_over(simulation().cpu().state()), 1);
  return {};
}

Debugger::Error Debugger::back_out(const Arguments& arguments) {
  if (!arguments.empty()) return no_argument("rout");
  const State& now = simulation().cpu().state();
  if (!goal::is_in_routine(now)) {
    out_ << "this is the main program, in no subroutine and no interrupt routine; 'rscan' goes to the start of its scan\n";
    return {};
  }
  go_back(goal::back_out(now), 1);
  return {};
}

Debugger::Error Debugger::back_network(const Arguments& arguments) {
  if (!arguments.empty()) return no_argument("rnetwork");
  go_back(goal::back_network_over(simulation().cpu().state(), listing()), 1);
  return {};
}

Debugger::Error Debugger::back_interrupt(const Arguments& arguments) {
  const auto ends = wants_end(arguments);
  if (!ends) return expects("rinterrupt", kBeginsOrEnds);
  const Program& program = simulation().cpu().program();
  go_back(*ends ? goal::back_interrupt_ends(program) : goal::back_interrupt_begins(program), 1);
  return {};
}

Debugger::Error Debugger::back_scan(const Arguments& arguments) {
  const auto count = parse_count(arguments);
  if (!count) return expects("rscan", "how many scans, for example: rscan 3");
  go_back(goal::back_scan(), *count);
  return {};
}

Debugger::Error Debugger::back_continue(const Arguments& arguments) {
  if (!arguments.empty()) return no_argument("rcontinue");
  go_back(goal::none(), 1, true);
  return {};
}

Debugger::Error Debugger::back_until(const Arguments& arguments) {
  std::string why;
  const auto target = find_place(arguments, "runtil", why);
  if (!target) return why;
  go_back(goal::place(*target), 1);
  return {};
}

Debugger::Error Debugger::at(const Arguments& arguments) {
  if (arguments.empty()) return expects("at", "a moment, for example: at 15.193ms, at -5ms, at start, at end");
  std::string why;
  const auto time = parse_moment(joined(arguments), history_, why);
  if (!time) return why;
  remember();
  if (!at_length([&] { return go_to_parsed(history_, *time); })) {
    kept_.pop_back();
    out_ << interruption_text() << '\n';
    return {};
  }
  note_going_elsewhere();
  show_place();
  note_the_past();
  return {};
}

std::optional<Debugger::Named> Debugger::one_range(const Arguments& arguments, std::string_view command, std::string& why) {
  if (arguments.size() == 1) return find_range(arguments[0], why);
  why = expects(command, fmt::format("one address, or event and a number, for example: {} VW100", command));
  return {};
}

/// Says who it was. `places`: what it was about; what of it is forced is said if the system wrote it.
std::optional<Writer> Debugger::reported(const WriterSearch& search, const std::vector<Bits>& places) {
  if (search.interrupted) {
    out_ << interruption_text() << '\n';
  } else if (!search.writer) {
    out_ << search.none << '\n';
  } else {
    out_ << search.writer->text << (search.writer->by_system ? forced_text(simulation().cpu(), places) : "") << '\n';
  }
  return search.writer;
}

std::optional<Writer> Debugger::report_writer(const MemoryRange& range, std::string_view name) {
  const auto find = [&] { return find_writer(history_, focus(), listing(), range, name, options_.stop_request); };
  return reported(at_length(find), {bits_of(range)});
}

std::optional<Writer> Debugger::report_attachment(std::uint8_t event) {
  const auto find = [&] { return find_writer(history_, focus(), listing(), event, options_.stop_request); };
  return reported(at_length(find), {});
}

/// `VW100`, or `event 8`.
Debugger::Error Debugger::report_writer_of(const Arguments& arguments, std::string_view command,
                                           std::optional<Writer>& writer) {
  if (const auto event = event_of(arguments)) {
    writer = report_attachment(*event);
    return {};
  }
  if (!arguments.empty() && stl::lower_case(arguments[0]) == "event") return expects_event(command, arguments);
  std::string why;
  const auto place = one_range(arguments, command, why);
  if (!place) return why;
  writer = report_writer(place->range, place->name);
  return {};
}

Debugger::Error Debugger::history(const Arguments& arguments) {
  const auto count = arguments.empty() ? kUsualInstructions : parse_count(arguments);
  if (!count || *count > kMostInstructions)
    return expects("history", fmt::format("how many instructions, up to {}, for example: history 30", kMostInstructions));
  const auto found = at_length([&] { return last_instructions(history_, focus(), *count, options_.stop_request); });
  if (!found) {
    out_ << interruption_text() << '\n';
    return {};
  }
  for (const Execution& one : *found)
    out_ << fmt::format("{}  {:<7} {}\n", clock_text(one.record.at), listing().routine_of(one.record.op),
                        execution_text(one, simulation().cpu().program()));
  return {};
}

Debugger::Error Debugger::timeline(const Arguments& arguments) {
  serial::Exchange exchange = simulation().has_master() ? simulation().master().exchange() : serial::Exchange{};
  if (arguments.empty() && exchange.request.empty())
    return expects("timeline", "a duration before the first 'send', for example: timeline 50ms");
  if (!arguments.empty()) {
    const auto before = parse_duration(joined(arguments));
    if (!before || *before == 0)
      return expects("timeline", fmt::format("a duration above 0 in {}, for example: timeline 50ms", kTimeUnits));
    const Time now = history_.now().time;
    exchange.request_start = now - std::min(now, *before);
  }
  const std::shared_ptr<const Program> program(std::shared_ptr<void>(), &simulation().cpu().program());  // not owned
  const auto report =
      at_length([&] { return timeline_of_past(history_, focus(), program, exchange.request_start, options_.stop_request); });
  out_ << (report ? stl::wrapped(to_text(*report, exchange, options_.colour), options_.width)
                  : fmt::format("{}\n", interruption_text()));
  return {};
}

/// Says it.
DecisionSearch Debugger::find_decision() {
  const DecisionSearch search =
      at_length([&] { return find_last_decision(history_, focus(), stepper_.host_timeout(), options_.stop_request); });
  for (const std::string& line : to_lines(search, listing())) out_ << line << '\n';
  if (search.interrupted) out_ << interruption_text() << '\n';
  return search;
}

/// `Conveyor (Q0.1) is 0; last written at …`, and a line for each step further back.
Debugger::Error Debugger::report_cause(const MemoryRange& range, std::string_view name) {
  const Cpu& cpu = simulation().cpu();
  const std::string value = value_text(cpu.program(), range, range.bytes_in(cpu.state().image));
  const auto lines = at_length([&] { return memory_cause(history_, focus(), range, options_.stop_request); });
  if (!lines) {
    out_ << interruption_text() << '\n';
    return {};
  }
  out_ << fmt::format("{} is {}; {}\n", name, value, fmt::join(*lines, "\n  "));
  if (const std::string forced = forced_text(cpu, {bits_of(range)}); !forced.empty()) out_ << forced << '\n';
  return {};
}

/// Whether an expectation has failed where it stands: then it says why.
bool Debugger::report_failed() {
  if (failed_.memory.empty() || failed_.station != focus() || failed_.moment != history_.now()) return false;
  for (const MemoryRange& range : failed_.memory) report_cause(range, named(simulation().cpu().program(), range));
  return true;
}

Debugger::Error Debugger::why(const Arguments& arguments) {
  if (arguments.empty()) {
    if (!report_failed()) find_decision();
    return {};
  }
  std::string wrong;
  const auto place = one_range(arguments, "why", wrong);
  return place ? report_cause(place->range, named(simulation().cpu().program(), place->range)) : Error(wrong);
}

Debugger::Error Debugger::back_to_decision(const Arguments& arguments) {
  if (!arguments.empty()) return no_argument("rwhy");
  const DecisionSearch search = find_decision();
  if (const auto origin = search.origin())
    go_to(origin->moment);
  else
    out_ << fmt::format("rwhy goes nowhere: {}\n", search.why_no_origin());
  return {};
}

void Debugger::go_to(const Moment& moment) {
  remember();
  history_.go_to(moment);
  note_going_elsewhere();
  show_place();
  note_the_past();
}

Debugger::Error Debugger::who(const Arguments& arguments) {
  std::optional<Writer> writer;
  return report_writer_of(arguments, "who", writer);
}

Debugger::Error Debugger::back_to_write(const Arguments& arguments) {
  std::optional<Writer> writer;
  if (Error error = report_writer_of(arguments, "rwho", writer)) return error;
  if (writer) go_to(writer->moment);
  return {};
}

Debugger::Error Debugger::fork(const Arguments& arguments) {
  if (!arguments.empty()) return no_argument("fork");
  if (!history_.in_the_past()) {
    out_ << "this is the newest moment: nothing has run after it\n";
    return {};
  }
  act(SetMemory{});
  return {};
}

Debugger::Error Debugger::past(const Arguments& arguments) {
  if (!arguments.empty()) return no_argument("past");
  const History::Usage usage = history_.usage();
  constexpr double kMegabyte = 1 << 20;
  out_ << fmt::format(
      "from {}, {}, to {}; now {}\n"
      "{}, one every {} or more; {:.1f} of {:.0f} MB; {} from outside\n",
      moment_text(usage.oldest.time), oldest_text(history_), moment_text(history_.newest().time),
      moment_text(history_.now().time), counted(usage.checkpoints, "checkpoint"), format_duration(usage.interval),
      static_cast<double>(usage.bytes) / kMegabyte, static_cast<double>(options_.history.bound) / kMegabyte,
      counted(history_.actions().size(), "action"));
  return {};
}

Debugger::Error Debugger::restart(const Arguments& arguments) {
  if (!arguments.empty()) return no_argument("restart");
  remember();
  history_.restart();
  looked_at_.clear();
  note_new_branch();
  note_going_elsewhere();
  show_place();
  return {};
}

}  // namespace s7200::tools
