// The commands of the debugger: the table, and what each does.
#include <fmt/format.h>

#include <algorithm>
#include <ostream>

#include "interpreter/base/numbers.hpp"
#include "interpreter/base/text.hpp"
#include "interpreter/trace/text_trace.hpp"
#include "serial_sim/modbus/crc.hpp"
#include "tools/debugger/debugger.hpp"
#include "tools/views/machine_text.hpp"
#include "tools/views/memory.hpp"
#include "tools/views/report.hpp"
#include "tools/views/text_frame.hpp"

namespace s7200::tools {
namespace {

constexpr std::size_t kListed = 15, kListedBefore = 6;

/// The optional `[n]` of a command: 1 when it is not there, nothing when it is not a number above 0 or more follows.
std::optional<std::uint32_t> parse_count(const std::vector<std::string>& arguments) {
  if (arguments.empty()) return 1;
  const auto number = parse_decimal<std::uint32_t>(arguments[0]);
  return arguments.size() == 1 && number && *number > 0 ? number : std::nullopt;
}

/// `VW100 = 5` is written with or without blanks.
std::vector<std::string> assignments_of(const std::vector<std::string>& arguments) {
  std::vector<std::string> texts;
  bool open = false;
  for (const std::string& argument : arguments) {
    if ((open || argument.front() == '=') && !texts.empty())
      texts.back() += argument;
    else
      texts.push_back(argument);
    open = argument.back() == '=';
  }
  return texts;
}

std::string no_argument(std::string_view command) { return fmt::format("{} takes no argument", command); }

constexpr std::string_view kBackwards = "It stops at breakpoints and watches on the way. Hits are not counted backwards.";

constexpr std::string_view kPlaces = "a line number, SBR n, INT n or NETWORK n";

}  // namespace

const std::vector<Debugger::Command>& Debugger::commands() {
  static const std::vector<Command> kTable{
      {"step", "s", "step [n]", "execute one instruction, or n, going into CALL and interrupt routines",
       "Each executed instruction is shown with its operands (inputs before it, results after it), S0 after it, and its "
       "time.",
       &Debugger::step, true},
      {"over", "o", "over", "execute one instruction; a CALL with all that it calls, interrupts in between too",
       "Breakpoints and watches inside still stop.", &Debugger::over, true},
      {"out", "u", "out", "run to the end of the subroutine or interrupt routine", "", &Debugger::out, true},
      {"scan", "n", "scan [n]", "run to the start of the next scan's program, or of the nth", "", &Debugger::scan, true},
      {"continue", "c", "continue [TIME]", "run until a breakpoint, a watch, an answer, STOP, or TIME has passed (10 s)",
       "TIME is simulated: 250ms, 2s, 1min. It ends in front of the first instruction after it. Ctrl-C stops it too.",
       &Debugger::continue_run, true},
      {"until", "t", "until LINE | SBR n | INT n | NETWORK n", "run to a place", "", &Debugger::until, true},
      {"back", "k", "back [n]", "back to the state before the last command that ran something, or the last n",
       "The last 64 are kept. Breakpoints, watches and their counts stay as they are. Going forward again plays what has "
       "run, "
       "with what was done to the PLC; 'set', 'input', 'send' in the past begin a new branch.",
       &Debugger::back},
      {"rstep", "rs", "rstep [n]", "back by one instruction, or n, into subroutines and interrupt routines", kBackwards,
       &Debugger::back_step, true},
      {"rover", "ro", "rover", "back by one instruction; a CALL with all that it called, interrupts in between too",
       kBackwards, &Debugger::back_over, true},
      {"rout", "ru", "rout", "back to the CALL of this subroutine, or to what this interrupt routine interrupted",
       kBackwards, &Debugger::back_out, true},
      {"rscan", "rn", "rscan [n]", "back to the start of the scan's program, then of the one before, or of the nth",
       kBackwards, &Debugger::back_scan, true},
      {"rcontinue", "rc", "rcontinue", "back to the last breakpoint, change of a watch, or end of an answer", kBackwards,
       &Debugger::back_continue, true},
      {"runtil", "rt", "runtil LINE | SBR n | INT n | NETWORK n", "back to the last time that it was at a place", kBackwards,
       &Debugger::back_until, true},
      {"at", "", "at TIME | -TIME | start | end", "to a moment: at 15.193ms, or so long before now: at -5ms",
       "It stands in front of the first instruction at or after it. start is power-up, end the newest moment.",
       &Debugger::at},
      {"who", "", "who ADDRESS", "the instruction that wrote an address last, without going there",
       "With its operands, the interrupt and the time; also if the value stayed the same. Entries of tables, strings and "
       "messages only if they changed it. 'rwho' goes there.",
       &Debugger::who},
      {"rwho", "rw", "rwho ADDRESS", "back to in front of the instruction that wrote an address last", kBackwards,
       &Debugger::back_to_write, true},
      {"branch", "", "branch", "forget what has run after this moment: going forward is new from here on",
       "What was done to the PLC later is not done again. back takes it back.", &Debugger::branch},
      {"past", "", "past", "how far back it can go, and what that takes", "", &Debugger::past},
      {"restart", "", "restart", "power up again; breakpoints, watches and displays are kept",
       "A new branch: back takes it back.", &Debugger::restart},
      {"break", "b", "break [PLACE | WHAT] [always] [if CONDITION] [hits N] [log 'TEXT']",
       "stop at a place or when something happens; alone: list",
       "PLACE: LINE, SBR n, INT n or NETWORK n. A line without an instruction stands for the next one that has one; boxes "
       "and "
       "coils stop only with power flow, or 'always'.\n"
       "  WHAT: event N [occurs | served], received or sent (a frame), xmt, rcv (its end), error [CODE], overflow (of a "
       "queue), "
       "lost (a character), mode, unanswered (a request).\n"
       "  CONDITION in STL terms: break 40 if VW3300 > 8 and M31.7. hits N stops from the Nth time on. log prints a line "
       "and "
       "goes on: break INT 123 log '{SMB2} at {time}'; also {scan} {line} {event}.",
       &Debugger::set_break},
      {"watch", "w", "watch ADDRESS[:COUNT]… [read | write | change] [if …] [hits N] [log …]",
       "stop after the instruction that changes M31.7, VB100, VW100, AC0 …, or reads or writes it",
       "Interrupt routines too. The system changes memory as well: inputs, SM bits, SMB2 before INT of event 8. 'write' "
       "stops "
       "also if the value stays the same. Entries of tables, strings and messages count only if they change.",
       &Debugger::watch},
      {"delete", "d", "delete N… | all", "remove breakpoints and watches", "", &Debugger::delete_stop},
      {"list", "l", "list [LINE | SBR n | INT n]", "the program around the current place or elsewhere",
       "> is the current line, * a breakpoint.", &Debugger::list},
      {"regs", "r", "regs", "time, place, calls, accumulators, flags, interrupts", "", &Debugger::registers},
      {"stack", "", "stack", "the nine levels of the logic stack", "", &Debugger::stack},
      {"print", "p", "print ADDRESS[:COUNT]…", "memory: VB100:16, VW100, VD20:real, M31.7, AC0, T5",
       "A double word that the program uses as a real is shown as one too.", &Debugger::print},
      {"display", "", "display [ADDRESS[:COUNT]… | off]", "print memory after each stop",
       "Further ones are added. Alone: print them now.", &Debugger::display},
      {"port", "", "port", "SMB30 in words, receiver, transmitter, and the master on the line", "", &Debugger::port},
      {"errors", "e", "errors", "run-time and fatal errors up to now", "", &Debugger::errors},
      {"trace", "", "trace on | off", "print interrupts, characters and errors while running", "", &Debugger::trace},
      {"set", "", "set ADDRESS=VALUE…", "write memory: set VW100=5 M0.3=1 VB4=16#FF; I addresses are the input points", "",
       &Debugger::set},
      {"input", "i", "input I0.3=1…", "switch input points; edges of I0.0 to I0.3 cause events 0 to 7",
       "The program finds the new level when the inputs are next read, or at once with an immediate instruction.",
       &Debugger::input},
      {"send", "", "send HEX… | 'TEXT' [crc]", "put a frame on the line from now on; crc appends the Modbus CRC",
       "p after a byte sends it with wrong parity. TEXT is ASCII, with \\r \\n \\t \\\\ \\' and \\xHH. 'continue' runs "
       "while it "
       "arrives and stops when the answer is complete.",
       &Debugger::send},
      {"help", "h", "help [COMMAND]", "this list, or more about a command", "", &Debugger::help},
      {"quit", "q", "quit", "end", "", &Debugger::quit},
  };
  return kTable;
}

const Debugger::Command* Debugger::find_command(std::string_view word, std::string& why) {
  const std::string name = lower_case(word);
  std::vector<const Command*> found;
  for (const Command& command : commands()) {
    if (name == command.name || name == command.short_form) return &command;
    if (command.name.starts_with(name)) found.push_back(&command);
  }
  if (found.size() == 1) return found[0];
  if (found.empty()) {
    why = fmt::format("unknown command '{}'; 'help' lists them", stl::shortened(word));
    return nullptr;
  }
  why = fmt::format("'{}' may be", stl::shortened(word));
  for (const Command* command : found) why += fmt::format("{} {}", command == found.front() ? "" : ",", command->name);
  return nullptr;
}

// --- running ---

Debugger::Error Debugger::step(const Arguments& arguments) {
  const auto count = parse_count(arguments);
  if (!count) return expects("step", "how many instructions, for example: step 5");
  go({.goal = [n = *count](const State&, std::uint32_t, const Stepper::Progress& p) { return p.executed >= n; },
      .show = Show::All});
  return {};
}

Debugger::Error Debugger::over(const Arguments& arguments) {
  if (!arguments.empty()) return no_argument("over");
  const State& now = simulation_.cpu().state();
  const auto at_same_level = [in_interrupt = now.in_interrupt, since = now.serving_since, depth = now.call_depth](
                                 const State& state, std::uint32_t, const Stepper::Progress& progress) {
    if (!progress.left || progress.executed == 0) return false;
    if (in_interrupt) return !state.in_interrupt || state.serving_since == since;
    return !state.in_interrupt && state.call_depth <= depth;
  };
  go({.goal = at_same_level, .show = Show::Started});
  return {};
}

Debugger::Error Debugger::out(const Arguments& arguments) {
  if (!arguments.empty()) return no_argument("out");
  const State& now = simulation_.cpu().state();
  if (now.mode == Mode::Run && !now.in_interrupt && now.call_depth == 0) {
    out_ << "this is the main program, in no subroutine and no interrupt routine; 'scan' runs to the next scan\n";
    return {};
  }
  const auto left = [in_interrupt = now.in_interrupt, depth = now.call_depth](const State& state, std::uint32_t,
                                                                              const Stepper::Progress&) {
    return !state.in_interrupt && (in_interrupt || state.call_depth < depth);
  };
  go({.goal = left});
  return {};
}

Debugger::Error Debugger::scan(const Arguments& arguments) {
  const auto count = parse_count(arguments);
  if (!count) return expects("scan", "how many scans, for example: scan 3");
  const std::uint64_t target = simulation_.cpu().state().scans + *count;
  go({.goal = [target](const State& state, std::uint32_t, const Stepper::Progress&) {
    return state.scans >= target && !state.in_interrupt;
  }});
  return {};
}

Debugger::Error Debugger::continue_run(const Arguments& arguments) {
  Run run{.goal = [](const State&, std::uint32_t, const Stepper::Progress&) { return false; }, .stop_at_answer = true};
  if (!arguments.empty()) {
    const auto time = parse_duration(joined(arguments));
    if (!time || *time == 0) return expects("continue", "a duration, for example: continue 250ms");
    run.limit = *time;
  }
  go(run);
  return {};
}

Debugger::Error Debugger::until(const Arguments& arguments) {
  std::string why;
  const auto target = find_place(arguments, "until", why);
  if (!target) return why;
  go({.goal = [target = *target](const State&, std::uint32_t op, const Stepper::Progress& progress) {
    return op == target && progress.left;
  }});
  return {};
}

Debugger::Error Debugger::back(const Arguments& arguments) {
  const auto count = parse_count(arguments);
  if (!count) return expects("back", "how many commands, for example: back 2");
  if (kept_.empty()) {
    out_ << "there is no earlier state: nothing has run since power-up, or all states kept have been used\n";
    return {};
  }
  if (*count > kept_.size()) out_ << fmt::format("only {} earlier states are kept\n", kept_.size());
  kept_.resize(kept_.size() - std::min<std::size_t>(*count, kept_.size()) + 1);
  const History::BranchPtr left = history_.here().branch;
  history_.return_to(kept_.back().place);
  out_ << fmt::format("back to before '{}'\n", stl::printable(kept_.back().command));
  kept_.pop_back();
  last_op_.reset();
  if (history_.here().branch != left) note_new_branch();
  show_place();
  return {};
}

Debugger::Error Debugger::back_step(const Arguments& arguments) {
  const auto count = parse_count(arguments);
  if (!count) return expects("rstep", "how many instructions, for example: rstep 5");
  go_back([](const State&, std::uint32_t, const Stepper::Progress&) { return true; }, *count);
  return {};
}

Debugger::Error Debugger::back_over(const Arguments& arguments) {
  if (!arguments.empty()) return no_argument("rover");
  const State& now = simulation_.cpu().state();
  go_back(
      [in_interrupt = now.in_interrupt, since = now.serving_since, depth = now.call_depth](const State& state, std::uint32_t,
                                                                                           const Stepper::Progress&) {
        if (state.in_interrupt) return in_interrupt && state.serving_since == since && state.call_depth <= depth;
        return in_interrupt || state.call_depth <= depth;
      },
      1);
  return {};
}

Debugger::Error Debugger::back_out(const Arguments& arguments) {
  if (!arguments.empty()) return no_argument("rout");
  const State& now = simulation_.cpu().state();
  const bool in_subroutine = now.call_depth > (now.in_interrupt ? now.saved.call_depth : 0);
  if (!now.in_interrupt && !in_subroutine) {
    out_ << "this is the main program, in no subroutine and no interrupt routine; 'rscan' goes to the start of its scan\n";
    return {};
  }
  go_back(
      [in_interrupt = now.in_interrupt && !in_subroutine, since = now.serving_since, in_any = now.in_interrupt,
       depth = now.call_depth](const State& state, std::uint32_t, const Stepper::Progress&) {
        if (in_interrupt) return !state.in_interrupt;
        return state.in_interrupt == in_any && (!in_any || state.serving_since == since) && state.call_depth < depth;
      },
      1);
  return {};
}

Debugger::Error Debugger::back_scan(const Arguments& arguments) {
  const auto count = parse_count(arguments);
  if (!count) return expects("rscan", "how many scans, for example: rscan 3");
  go_back(
      [seen = std::optional<std::uint64_t>()](const State& state, std::uint32_t op, const Stepper::Progress&) mutable {
        if (state.in_interrupt) return false;
        const bool begins = seen && *seen <= state.scans ? *seen != state.scans : op == 0;
        seen = state.scans;
        return begins;
      },
      *count);
  return {};
}

Debugger::Error Debugger::back_continue(const Arguments& arguments) {
  if (!arguments.empty()) return no_argument("rcontinue");
  go_back([](const State&, std::uint32_t, const Stepper::Progress&) { return false; }, 1, true);
  return {};
}

Debugger::Error Debugger::back_until(const Arguments& arguments) {
  std::string why;
  const auto target = find_place(arguments, "runtil", why);
  if (!target) return why;
  go_back([target = *target](const State&, std::uint32_t op, const Stepper::Progress&) { return op == target; }, 1);
  return {};
}

Debugger::Error Debugger::at(const Arguments& arguments) {
  constexpr std::string_view kTimes = "a moment, for example: at 15.193ms, at -5ms, at start, at end";
  std::string text = joined(arguments);
  const bool before_now = text.starts_with('-');
  if (before_now) text.erase(0, 1);
  auto time = parse_duration(text);
  if (lower_case(text) == "start") time = 0;
  if (lower_case(text) == "end") time = history_.newest().time;
  if (!time) return expects("at", kTimes);
  if (before_now) time = simulation_.time() - std::min(*time, simulation_.time());
  if (*time > history_.newest().time)
    return fmt::format("nothing has run after {}; 'continue TIME' goes on", moment_text(history_.newest().time));
  remember();
  if (*time == 0)
    history_.go_to(history_.usage().oldest);
  else
    history_.go_to(*time);
  last_op_.reset();
  show_place();
  note_the_past();
  return {};
}

std::optional<MemoryRange> Debugger::one_range(const Arguments& arguments, std::string_view command,
                                               std::string& why) const {
  if (arguments.size() == 1) return parse_range(arguments[0], simulation_.cpu().program(), why);
  why = expects(command, fmt::format("one address, for example: {} VW100", command));
  return {};
}

std::optional<LastWrite> Debugger::find_write(const MemoryRange& range, std::string_view name) {
  const WriteSearch search = find_last_write(simulation_, history_, range, options_.stop_request);
  if (search.interrupted) out_ << "interrupted by Ctrl-C\n";
  if (!search.write && !search.interrupted)
    out_ << fmt::format("nothing has written {} since power-up; it is {}\n", name, value_of(range));
  return search.write;
}

void Debugger::report_write(const LastWrite& write, const MemoryRange& range, std::string_view name) {
  const Program& program = simulation_.cpu().program();
  out_ << fmt::format("{} was {}, became {}, at {}\n", name, value_text(program, range, write.before),
                      value_text(program, range, write.after), moment_text(write.at));
  if (write.by)
    out_ << fmt::format("  by {} {}{}\n", listing_.routine_of(write.by->op), describe(*write.by, program),
                        write.in_interrupt ? fmt::format(", serving {}", event_text(write.event)) : "");
  else if (write.action)
    out_ << fmt::format("  by '{}', from outside\n", describe(history_.actions()[*write.action]));
  else
    out_ << "  by the system, between two instructions\n";
}

Debugger::Error Debugger::who(const Arguments& arguments) {
  std::string why;
  const auto range = one_range(arguments, "who", why);
  if (!range) return why;
  const std::string name = stl::upper_case(arguments[0]);
  if (const auto write = find_write(*range, name)) report_write(*write, *range, name);
  return {};
}

Debugger::Error Debugger::back_to_write(const Arguments& arguments) {
  std::string why;
  const auto range = one_range(arguments, "rwho", why);
  if (!range) return why;
  const std::string name = stl::upper_case(arguments[0]);
  const auto write = find_write(*range, name);
  if (!write) return {};
  report_write(*write, *range, name);
  remember();
  history_.go_to(write->moment);
  last_op_.reset();
  show_place();
  note_the_past();
  return {};
}

Debugger::Error Debugger::branch(const Arguments& arguments) {
  if (!arguments.empty()) return no_argument("branch");
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
      "from {}, where this session powered the CPU up, to {}; now {}\n"
      "{} checkpoints, one every {} or more; {:.1f} of {:.0f} MB; {} actions from outside\n",
      moment_text(usage.oldest.time), moment_text(history_.newest().time), moment_text(simulation_.time()),
      usage.checkpoints, format_duration(usage.interval), static_cast<double>(usage.bytes) / kMegabyte,
      static_cast<double>(options_.history.bound) / kMegabyte, history_.actions().size());
  return {};
}

Debugger::Error Debugger::restart(const Arguments& arguments) {
  if (!arguments.empty()) return no_argument("restart");
  remember();
  history_.restart();
  note_new_branch();
  last_op_.reset();
  for (StopPoint& stop : stepper_.stops) stop.hits = 0;
  show_place();
  return {};
}

// --- where to stop ---

/// A place that a command names; nothing, and `why`, when there is no such place.
std::optional<std::uint32_t> Debugger::find_place(const Arguments& arguments, std::string_view command, std::string& why) {
  const std::string text = stl::upper_case(joined(arguments));
  if (text.starts_with("NETWORK")) return op_of_network(text, command, why);
  const bool subroutine = text.starts_with("SBR"), interrupt = text.starts_with("INT");
  if (!subroutine && !interrupt) return op_of_line(text, command, why);
  const auto number = parse_decimal<std::uint32_t>(arguments.size() == 1 ? std::string_view(text).substr(3) : arguments[1]);
  if (!number || arguments.size() > 2) {
    why = expects(command, kPlaces);
    return {};
  }
  const Program& program = simulation_.cpu().program();
  const std::span<const std::uint32_t> heads =
      subroutine ? std::span<const std::uint32_t>(program.subroutine) : std::span<const std::uint32_t>(program.interrupt);
  if (*number < heads.size() && heads[*number] != kNoRoutine) return heads[*number];
  why = fmt::format("the program has no {} {}", subroutine ? "SBR" : "INT", *number);
  return {};
}

std::optional<std::uint32_t> Debugger::op_of_line(const std::string& text, std::string_view command, std::string& why) {
  const auto line = parse_decimal<std::uint32_t>(text);
  if (!line) {
    why = expects(command, kPlaces);
    return {};
  }
  const auto op = listing_.op_from_line(*line);
  if (!op)
    why = fmt::format("the last instruction is in line {}", listing_.last_line());
  else if (listing_.line_of(*op) != *line)
    out_ << fmt::format("line {} has no instruction; the next one is in line {}\n", *line, listing_.line_of(*op));
  return op;
}

std::optional<std::uint32_t> Debugger::op_of_network(const std::string& text, std::string_view command, std::string& why) {
  const std::size_t digit = text.find_first_of("0123456789");
  const auto number = digit == std::string::npos ? std::nullopt : parse_decimal<std::uint32_t>(text.substr(digit));
  const auto op = number ? listing_.op_of_network(*number) : std::nullopt;
  if (!op)
    why = number ? fmt::format("the program has no NETWORK {} with an instruction", *number) : expects(command, kPlaces);
  return op;
}

// --- looking ---

Debugger::Error Debugger::list(const Arguments& arguments) {
  const auto mark = [this](std::uint32_t op) { return mark_of(op); };
  if (arguments.empty()) {
    out_ << listing_.around(listing_.line_of(current_op().value_or(0)), kListedBefore, kListed, mark);
    return {};
  }
  if (const auto line = parse_decimal<std::uint32_t>(joined(arguments))) {
    if (*line > listing_.last_line()) return fmt::format("the last instruction is in line {}", listing_.last_line());
    out_ << listing_.around(*line, kListedBefore, kListed, mark);
    return {};
  }
  std::string why;
  const auto op = find_place(arguments, "list", why);
  if (!op) return why;
  out_ << listing_.around(listing_.line_of(*op), 0, kListed, mark);
  return {};
}

Debugger::Error Debugger::registers(const Arguments& arguments) {
  if (!arguments.empty()) return no_argument("regs");
  out_ << registers_text(simulation_.cpu(), listing_);
  return {};
}

Debugger::Error Debugger::stack(const Arguments& arguments) {
  if (!arguments.empty()) return no_argument("stack");
  out_ << stack_text(simulation_.cpu().state());
  return {};
}

Debugger::Error Debugger::ranges_of(const Arguments& arguments, std::vector<MemoryRange>& ranges) const {
  for (const std::string& text : arguments) {
    std::string why;
    const auto range = parse_range(text, simulation_.cpu().program(), why);
    if (!range) return why;
    ranges.push_back(*range);
  }
  return {};
}

Debugger::Error Debugger::print(const Arguments& arguments) {
  if (arguments.empty()) return expects("print", "addresses, for example: print VB100:16 M31.7 AC0");
  std::vector<MemoryRange> ranges;
  if (Error error = ranges_of(arguments, ranges)) return error;
  for (const MemoryRange& range : ranges) out_ << dump_text(simulation_.cpu(), range);
  return {};
}

Debugger::Error Debugger::display(const Arguments& arguments) {
  if (arguments.size() == 1 && lower_case(arguments[0]) == "off") {
    displayed_.clear();
    return {};
  }
  std::vector<MemoryRange> ranges;
  if (Error error = ranges_of(arguments, ranges)) return error;
  displayed_.insert(displayed_.end(), ranges.begin(), ranges.end());
  if (displayed_.empty()) out_ << "nothing is displayed; 'display VW100' adds to it\n";
  for (const MemoryRange& range : displayed_) out_ << dump_text(simulation_.cpu(), range);
  return {};
}

Debugger::Error Debugger::port(const Arguments& arguments) {
  if (!arguments.empty()) return no_argument("port");
  out_ << port_text(simulation_);
  return {};
}

Debugger::Error Debugger::errors(const Arguments& arguments) {
  if (!arguments.empty()) return no_argument("errors");
  const std::string text = errors_text(simulation_.cpu());
  out_ << (text.empty() ? "no errors\n" : text);
  return {};
}

Debugger::Error Debugger::trace(const Arguments& arguments) {
  const std::string word = arguments.size() == 1 ? lower_case(arguments[0]) : "";
  if (word != "on" && word != "off") return expects("trace", "on or off");
  tracing_ = word == "on";
  return {};
}

Debugger::Error Debugger::help(const Arguments& arguments) {
  if (arguments.empty()) {
    for (const Command& command : commands())
      out_ << fmt::format("{:<3} {:<33} {}\n", command.short_form, command.syntax, command.meaning);
    out_ << "A name may be cut short while it stays clear. ';' separates commands, '#' begins a comment.\n"
            "On a terminal an empty line repeats step, over, out, scan, continue and until.\n";
    return {};
  }
  std::string why;
  const Command* command = find_command(arguments[0], why);
  if (!command) return why;
  out_ << fmt::format("{}\n  {}\n", command->syntax, command->meaning);
  if (!command->more.empty()) out_ << fmt::format("  {}\n", command->more);
  if (!command->short_form.empty()) out_ << fmt::format("  short: {}\n", command->short_form);
  return {};
}

Debugger::Error Debugger::quit(const Arguments& arguments) {
  if (!arguments.empty()) return no_argument("quit");
  quit_asked_ = true;
  return {};
}

// --- doing something to the PLC ---

Debugger::Error Debugger::assign_all(const Arguments& arguments, bool inputs_only) {
  std::vector<Assignment> assignments;
  for (const std::string& text : assignments_of(arguments)) {
    std::string why;
    const auto assignment = parse_assignment(text, simulation_.cpu().program(), why);
    if (!assignment) return why;
    if (inputs_only && assignment->place.area != Area::I)
      return fmt::format("'{}' is not an input; 'input' expects for example I0.3=1, and 'set' writes other memory",
                         stl::shortened(text));
    assignments.push_back(*assignment);
  }
  act(SetMemory{assignments});
  const auto is_input = [](const Assignment& a) { return a.place.area == Area::I; };
  if (std::any_of(assignments.begin(), assignments.end(), is_input) && standing_at(simulation_.cpu().state()))
    out_ << "the input points are set; the program finds them in I when the next scan reads its inputs\n";
  return {};
}

Debugger::Error Debugger::set(const Arguments& arguments) {
  if (arguments.empty()) return expects("set", "an address and a value, for example: set VW100=5");
  return assign_all(arguments, false);
}

Debugger::Error Debugger::input(const Arguments& arguments) {
  if (arguments.empty()) return expects("input", "an input and its level, for example: input I0.3=1");
  return assign_all(arguments, true);
}

Debugger::Error Debugger::send(const Arguments& arguments) {
  Arguments words = arguments;
  const bool crc = !words.empty() && lower_case(words.back()) == "crc";
  if (crc) words.pop_back();
  if (words.empty())
    return expects("send",
                   "a frame in hex or text in quotation marks, for example: send 01 03 00 00 00 02 crc, or send 'HELLO\\r'");
  serial::ParsedFrame parsed = parse_hex_or_quoted(joined(words));
  if (!parsed.ok()) {
    const serial::FrameError& error = parsed.errors[0];
    return fmt::format("send {}: column {}: {}", joined(words), error.column, error.message);
  }
  if (crc) modbus::append_crc(parsed.frame);
  const SerialFormat format = options_.master.over(simulation_.port_format());
  if (serial::has_wrong_parity(parsed.frame) && format.parity == Parity::None)
    return "send: a byte with wrong parity (p) needs a format with parity";
  if (simulation_.master().busy()) {
    out_ << "the last frame is still under way or waiting for its answer; 'continue' runs to its end\n";
    return {};
  }
  act(SendFrame{format, options_.master.request(parsed.frame)});
  const std::string text = request_text(serial::bytes_of(parsed.frame));
  out_ << fmt::format("on the line from now on: {}{} ({})\n", serial::to_hex(parsed.frame), text.empty() ? "" : "  " + text,
                      format_text(format));
  if (!simulation_.freeport().active)
    out_ << fmt::format("port {} is not in Freeport mode: the program will not hear it\n", simulation_.port());
  return {};
}

}  // namespace s7200::tools
