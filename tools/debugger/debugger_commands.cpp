// The table of the commands, and the bodies of those that run forwards, look at the PLC, or do something to it.
#include <fmt/format.h>

#include <algorithm>
#include <ostream>

#include "interpreter/base/nearest.hpp"
#include "interpreter/base/numbers.hpp"
#include "interpreter/base/text.hpp"
#include "interpreter/base/wrapped.hpp"
#include "interpreter/trace/text_trace.hpp"
#include "tools/debugger/debugger.hpp"
#include "tools/session/causes/two_masters.hpp"
#include "tools/session/commands/bad_pointers.hpp"
#include "tools/session/commands/fault_words.hpp"
#include "tools/session/commands/force_words.hpp"
#include "tools/session/commands/frame_words.hpp"
#include "tools/session/commands/line_words.hpp"
#include "tools/session/commands/mode_words.hpp"
#include "tools/session/past/past_words.hpp"
#include "tools/session/stops/goals.hpp"
#include "tools/session/stops/stop_words.hpp"
#include "tools/views/faults.hpp"
#include "tools/views/machine_text.hpp"
#include "tools/views/memory.hpp"
#include "tools/views/report.hpp"
#include "tools/views/text_frame.hpp"

namespace s7200::tools {
namespace {

constexpr std::size_t kListed = 15, kListedBefore = 6;

constexpr std::string_view kAboutCommands =
    R"(A name may be cut short while it stays clear. ';' separates commands, '//' begins a comment, '#' at the start of a line too.
On a terminal an empty line repeats the last step or run, forwards or backwards; the tab key completes commands, addresses,
places and files.
Examples:
  continue 2s; send 01 03 00 0a 00 01 crc; continue      what a slave answers
  break unanswered; continue; rwho event 8; history 9    why it did not answer
  break wrong; continue                                  an answer that cannot be taken
  watch VW100 if VW100 > 8; continue; who VW100          who writes an address
  force I0.3=1; scan 2; status NETWORK 2                 what the program does with an input
  display VW100; layout on                               keep an eye on memory
  save here.json; record here.yaml                       keep this session; make a test of it
)";

constexpr std::string_view kBackwards =
    "It stops at breakpoints and watches on the way, also before they were set unless they wait for a number of hits.";

constexpr std::string_view kMoreAboutPrint =
    R"(; all but /d show the bits of a real. VB100:real, VB100:word:4 or
AC0:byte take memory in bytes and accumulators as another type: byte, word, dword, real. What a pointer points to is a
byte unless one of them is asked for; of one that points nowhere it says who wrote it. &VB100 is a pointer to VB100, as in
VD20 = &VB100. SMB30 is shown in words, timers with bit, preset and base. A double word that the program uses as a real is
shown as one too.
In expressions words and double words have a sign, and beside them a constant above 32767 or 2147483647 stands for its
bits: VW20 = 16#FFFF is VW20 = -1. For example: print VD20:real:4 SMB30 T37, print /x VW100:8, print VW2 * 2 + 1.)";

}  // namespace

const std::vector<Debugger::Command>& Debugger::commands() {
  static const std::string kPrintSyntax = fmt::format("print [{}] ADDRESS… | EXPRESSION", print_forms_text(" | "));
  static const std::string kPrintWords = print_forms_text(" ");
  static const std::string kAboutPrint = print_forms_meanings() + std::string(kMoreAboutPrint);
  static const std::vector<Command> kTable{
      {"step", "s", "step [n]", "execute one instruction, or n, going into CALL and interrupt routines",
       R"(Each executed instruction is shown with its operands (inputs before it, results after it), S0 after it, and its
time. For example: break INT 123; continue; step 5.)",
       &Debugger::step, Takes::Nothing, true},
      {"over", "o", "over", "execute one instruction; a CALL with all that it calls, interrupts in between too",
       "Breakpoints and watches inside still stop. For example: break 83; continue; over.", &Debugger::over, Takes::Nothing,
       true},
      {"out", "u", "out", "run to the end of the subroutine or interrupt routine", "", &Debugger::out, Takes::Nothing, true},
      {"network", "nw", "network", "run to the next network of this routine; a CALL with all that it calls, as 'over'", "",
       &Debugger::network, Takes::Nothing, true},
      {"interrupt", "int", "interrupt [begins | ends]", "run until the next interrupt routine begins, or the next one ends",
       "It stands in front of its first instruction, or in front of the first one after it.", &Debugger::interrupt,
       Takes::Nothing, true, "begins ends"},
      {"scan", "n", "scan [n]", "run to the start of the next scan's program, or of the nth",
       "For example: input I0.3=1; scan 2; print Q0.0.", &Debugger::scan, Takes::Nothing, true},
      {"continue", "c", "continue [TIME] [scan]",
       "run until a breakpoint, a watch, an answer, STOP, or TIME has passed (10 s)",
       R"(TIME is simulated, in ns, us, ms, s, min or h: 250ms, 1.5s, 20min. The run ends before the first instruction after
that time, which is mostly within a scan; with 'scan' it goes on to the end of that scan, where the outputs are written.
Ctrl-C stops it too. With a bridge, --realtime or --speed commands may be typed while it runs: they are carried out at
once, and the run goes on after set, force, print and all others that do not move it.)",
       &Debugger::continue_run, Takes::Nothing, true, "scan"},
      {"until", "t", "until LINE | SBR n | INT n | LBL n | NETWORK n", "run to a place", "", &Debugger::until, Takes::Places,
       true},
      {"back", "k", "back [n]", "back to the state before the last command that ran something, or the last n",
       R"(The last 64 are kept. Breakpoints and watches stay. Going forward again plays what has run, with what was done to
the PLC; 'set', 'input', 'send' in the past begin a new branch.)",
       &Debugger::back},
      {"rstep", "rs", "rstep [n]", "back by one instruction, or n, into subroutines and interrupt routines", kBackwards,
       &Debugger::back_step, Takes::Nothing, true},
      {"rover", "ro", "rover", "back by one instruction; a CALL with all that it called, interrupts in between too",
       kBackwards, &Debugger::back_over, Takes::Nothing, true},
      {"rout", "ru", "rout", "back to the CALL of this subroutine, or to what this interrupt routine interrupted",
       kBackwards, &Debugger::back_out, Takes::Nothing, true},
      {"rnetwork", "rnw", "rnetwork", "back to the start of this network, or of the one before", kBackwards,
       &Debugger::back_network, Takes::Nothing, true},
      {"rinterrupt", "ri", "rinterrupt [begins | ends]", "back to where an interrupt routine last began, or ended",
       kBackwards, &Debugger::back_interrupt, Takes::Nothing, true, "begins ends"},
      {"rscan", "rn", "rscan [n]", "back to the start of the scan's program, then of the one before, or of the nth",
       kBackwards, &Debugger::back_scan, Takes::Nothing, true},
      {"rcontinue", "rc", "rcontinue", "back to the last breakpoint, change of a watch, or end of an answer", kBackwards,
       &Debugger::back_continue, Takes::Nothing, true},
      {"runtil", "rt", "runtil LINE | SBR n | INT n | LBL n | NETWORK n", "back to the last time that it was at a place",
       kBackwards, &Debugger::back_until, Takes::Places, true},
      {"at", "", "at TIME | -TIME | start | end", "to a moment: at 15.193ms, or so long before now: at -5ms",
       R"(TIME is in ns, us, ms, s, min or h. It stands in front of the first instruction at or after it. start is the oldest
moment, which is power-up as long as nothing is forgotten, end the newest one.)",
       &Debugger::at, Takes::Moments, false, "start end"},
      {"who", "", "who ADDRESS | event N",
       "the instruction that wrote an address last, or attached an event, without going there",
       R"(With its operands, the interrupt and the time; also if the value stayed the same. Entries of tables, strings and
messages only if they changed it. What an event of a system file has set is named as what a command has. who *VD3570
takes the address that the pointer holds now. 'rwho' goes there.)",
       &Debugger::who, Takes::Writers, false, "event"},
      {"rwho", "rw", "rwho ADDRESS | event N", "back to in front of the instruction that 'who' names",
       "rwho event 8 goes to where the program last changed which routine gets the characters: where it dropped a frame.",
       &Debugger::back_to_write, Takes::Writers, true, "event"},
      {"why", "", "why [ADDRESS]",
       "what decided that it has come here: contacts, a jump or a conditional return, without going there",
       R"(With an address: who wrote it last, which contacts decided that, and so on back to an input; or which instructions
could write it, and what keeps them from it. Where an 'expect' or a step of a scenario has just failed, why is about
the memory that was not as expected.
Without one: the contacts of this rung, or what the main program or the interrupt routine came by last, with operand values.
While a master or a program waits for an answer, and where it gives up: also what has left the request without one,
be it the program, an event that is not attached, a port in PPI mode, or the line that lost it or its answer; or that
it was for another station. That comes first, what led to this place last.)",
       &Debugger::why, Takes::Addresses},
      {"rwhy", "ry", "rwhy", "back to in front of the instruction that 'why' names",
       R"(Of a jump or conditional return: in front of it, after the contacts that decide on it, which 'history' shows. Of
contacts: after the last of them, where S0 is what they have decided; if it stands there already, in front of
the first.)",
       &Debugger::back_to_decision, Takes::Nothing, true},
      {"history", "", "history [n]", "the last 10 instructions before now, or n, with their operands and comments",
       "For example, what led to the end of an interrupt routine: interrupt ends; history 20.", &Debugger::history},
      {"timeline", "", "timeline [TIME]", "what the CPU did since the last 'send', or for so long before now",
       R"(Characters, interrupts with what they waited for, XMT, and the way of the main program; in ms after the frame
began. For example: send 01 03 00 0a 00 01 crc; continue; timeline, or timeline 50ms.)",
       &Debugger::timeline},
      {"fork", "", "fork", "forget what has run after this moment: going forward is new from here on",
       "What was done to the PLC later is not done again. back takes it back.", &Debugger::fork},
      {"past", "", "past", "how far back it can go, and what that takes", "", &Debugger::past},
      {"power", "", "power [all] [TIME] [lost] | off | on",
       "switch power off and on again: the CPU begins with what it has kept",
       R"(off and on switch this PLC alone; time goes on, and going back crosses both: power off; continue 2s; power on.
power alone, or with a TIME, does both at once and begins a new branch at time 0, which back takes back. TIME is how long
it was off, in ns, us, ms, s, min or h; the clock goes on: power 8h. lost: too long for the RAM, only the EEPROM is left. Of
a system that is every PLC: power all 8h.)",
       &Debugger::power, Takes::Power},
      {"save", "", "save FILE [!]",
       "write where this session stands, and its past; 'load' returns there, in another session too",
       R"(The file has all that was done to the PLC, and when; 'load' runs that again, which comes to the same state to
the bit. Breakpoints and watches are in it too, and count their hits anew; displays are not. It fits the same program,
CPU, execution times and version of s7200, started with the same options. An existing file is replaced if save has
written it; ! replaces any.)",
       &Debugger::save, Takes::Files},
      {"load", "", "load FILE [!]", "go to where 'save' was given",
       R"(Its breakpoints and watches join those that are set. back returns to here, and leaves them. With ! also a session of
more than a week of simulated time, which is run again.)",
       &Debugger::load, Takes::Sessions},
      {"restart", "", "restart", "power up again; breakpoints, watches and displays are kept",
       "A new branch: back takes it back.", &Debugger::restart},
      {"break", "b", "break [PLACE | WHAT | CONDITION] [always] [if CONDITION] [hits N] [log 'TEXT']",
       "stop at a place, when something happens, or when a condition comes to hold; alone: list",
       R"(PLACE: LINE, FILE:LINE, SBR n, INT n, LBL n or NETWORK n. A line without an instruction stands for the next one that
has one; boxes and coils stop only with power flow, or 'always'.
WHAT: event N [occurs | served], received or sent (a frame), xmt, rcv (its end), error [CODE], overflow (of a
queue), lost (a character), mode, unanswered (a request on a line of this PLC), wrong (an answer to one, which it
cannot take: wrong parity or CRC, cut short, of another station or function; an exception is an answer). 'send' and
polling masters use their own time-outs. A request from a bridge, or from a PLC (Modbus RTU, one XMT each), counts as
unanswered if nothing is sent within --timeout or before the next request. PPI requests are not covered. To a request
that is not Modbus RTU an answer is wrong if its characters are damaged.
CONDITION in STL terms: break 40 if VW3300 > 8 and M31.7; a constant that an operand can never be is refused. Without a
place, break VW0 > 3, the run stops after the instruction that makes it hold.
hits N stops from the Nth time on since it was set: moments before that do not count when 'back' or 'at' lead there.
log prints a line and goes on: break INT 123 log '{SMB2} at {time}'; also {scan} {line} {event}.)",
       &Debugger::set_break, Takes::Break},
      {"watch", "w", "watch ADDRESS[:COUNT]… [read | write | read write | change] [if …] [hits N] [log …]",
       "stop after the instruction that changes M31.7, VB100, VW100, AC0 …, or reads or writes it; alone: list",
       R"(Interrupt routines too. The system changes memory as well: inputs, SM bits, SMB2 before INT of event 8. 'read' and
'write' are for instructions alone, and 'write' stops also if the value stays the same. Entries of tables, strings and
messages count only if they change. watch *VD3570 takes the address that the pointer holds now, and stays there.)",
       &Debugger::watch, Takes::Watch},
      {"delete", "d", "delete N… | all", "remove breakpoints and watches", "", &Debugger::delete_stop, Takes::Nothing, false,
       "all"},
      {"station", "", "station [NAME]", "the stations of a system: where each stands; or go over to another one",
       R"(PLCs first, then the peers and bridges on their lines, which have no program to step through. Steps, addresses, places
and 'send' are about one station at a time; all of them run, and breakpoints and watches stay with the station that
they were set at. What stops at another station goes over to it.)",
       &Debugger::station, Takes::Stations},
      {"list", "l", "list [LINE | SBR n | INT n | LBL n | NETWORK n]", "the program around the current place or elsewhere",
       "> is the current line, * a breakpoint. For example: list INT 123, or list 80.", &Debugger::list, Takes::Places},
      {"status", "", "status [LINE | SBR n | INT n | LBL n | NETWORK n]",
       "the program with power flow and operands of each instruction's last execution",
       "Of the last 2 s at least. S0 is the top of the logic stack after it. For example: status NETWORK 2.",
       &Debugger::status, Takes::Places},
      {"regs", "r", "regs", "time, place, calls, accumulators, flags, interrupts", "", &Debugger::registers},
      {"record", "", "record FILE.yaml [!]", "write this session, up to now, as a scenario that 's7200 test' replays",
       R"(Frames, those that came over a bridge too, memory and inputs that were set, what was forced, modes, faults of the line
and power cycles, each at its time, and the answers that came, which may come up to 5 ms earlier or later ('tolerance'). What
was printed or expected is expected again where it was, and what is displayed at the end. A session without any of these
is refused: it would test nothing.
What no scenario can do is left out, and said: something set or sent while a frame or its answer was under way, a request
given up within its answer, 'goto' and the logic stack of an editor. 'power all' of a system, and a session with --memory,
cannot be recorded. A file that exists is replaced if ! follows its name.)",
       &Debugger::record, Takes::Files},
      {"stack", "sta", "stack", "the nine levels of the logic stack", "", &Debugger::stack},
      {"print", "p", kPrintSyntax,
       "memory: VB100:16, VW100, VD20:real, M31.7, AC0, T37, HC0, *VD3570:8, *AC1:word; or VW2 * 2 + 1", kAboutPrint,
       &Debugger::print, Takes::Addresses, false, kPrintWords},
      {"expect", "", "expect EXPRESSION", "a failure unless it holds: a script with such lines is a test",
       "expect VW20 = 5 and M0.1. A script ends at the first that does not hold, with exit code 1.", &Debugger::expect,
       Takes::Addresses},
      {"display", "", "display [ADDRESS[:COUNT]… | off]", "print memory after each stop",
       R"(Further ones are added. Alone: print them now. display *VD3570 takes the address that the pointer holds now, and
stays there.)",
       &Debugger::display, Takes::Addresses, false, "off"},
      {"port", "", "port", "SMB30 in words, receiver, transmitter, and the master on the line",
       "For example, in the middle of a frame: send 01 03 00 0a 00 01 crc; continue 3ms; port.", &Debugger::port},
      {"errors", "e", "errors", "run-time and fatal errors up to now", "", &Debugger::errors},
      {"trace", "", "trace on | off", "print interrupts, characters and errors while running", "", &Debugger::trace,
       Takes::Nothing, false, "on off"},
      {"layout", "", "layout on | off", "keep program, status and memory in view, in the upper part of a terminal",
       R"(It needs 80×24 or more. Above: where it stands, the instructions around it with their last execution, and the
memory that 'display' names, or the registers. Below: the prompt.)",
       &Debugger::layout, Takes::Nothing, false, "on off"},
      {"set", "", "set ADDRESS=VALUE…",
       "write memory: set VW100=5 M0.3=1 VB4=16#FF VD8=&VB100; I addresses are the input points",
       "SMB28 and SMB29 are the potentiometers, SM0.7 is the mode switch; the rest of SM0.0 to SM29.7 only the CPU\n"
       "writes.",
       &Debugger::set, Takes::Addresses},
      {"input", "i", "input I0.3=1…", "switch input points; edges of I0.0 to I0.3 cause events 0 to 7",
       "The program finds the new level when the inputs are next read, or at once with an immediate instruction.",
       &Debugger::input, Takes::Addresses},
      {"force", "", "force [ADDRESS=VALUE…]", "hold points of I and Q, V and M memory, AI and AQ at a value; alone: list",
       R"(As a programming device forces: force I0.3=1 Q0.0=0 VW100=5. Inputs have the value when they are read, outputs
when they are written (end of scan, immediate, STOP), memory after each program: in between the program may
change it. Up to 16 values of memory: bytes, words, double words; AI and AQ words. Shown in red. Edges and
counters see the terminal. The CPU keeps it without power; going back undoes it.)",
       &Debugger::force, Takes::Forced},
      {"unforce", "", "unforce ADDRESS… | all", "release what is forced",
       "Inputs follow their terminals again, outputs their image; memory keeps what it has.", &Debugger::unforce,
       Takes::ForcedNow, false, "all"},
      {"mode", "", "mode run | stop", "switch the CPU to RUN or STOP, as a programming device does",
       "After a fatal error only 'restart' or 'power' bring it back.", &Debugger::mode, Takes::Nothing, false, "run stop"},
      {"send", "", "send HEX… | 'TEXT' [crc] | read ADDRESS[:COUNT] | write ADDRESS=VALUE… [station n] | cancel",
       "send a frame, with its Modbus CRC if crc is given; cancel abandons the request",
       R"(p after a byte sends it with wrong parity. TEXT is ASCII, with \r \n \t \\ \' and \xHH. 'continue' runs while it
arrives and stops when the answer is complete. After cancel a character that has begun is still sent; then the master is
ready for the next request.)",
       &Debugger::send, Takes::Nothing, false, "read write cancel"},
      {"fault", "", "fault KIND[:PARAMETER=VALUE,…] [station=NAME] | none",
       "inject a fault on the line, or clear all faults",
       R"(As --fault of 's7200 run': fault flip:character=3,bit=5, fault noise:ber=0.001, fault cut:from=2ms. It counts
exchanges and times from now; 's7200 help faults' has all parameters. In a system station=NAME says whose characters it
strikes, as 'station' of a system file: fault parity:character=2 station=slave2. Going back undoes it. Alone: the
faults in force, and how often each has happened.)",
       &Debugger::fault, Takes::Faults, false, "none"},
      {"help", "h", "help [COMMAND]", "this list, or more about a command", "", &Debugger::help, Takes::Commands},
      {"quit", "q", "quit", "end", "", &Debugger::quit},
  };
  return kTable;
}

const Debugger::Command* Debugger::find_command(std::string_view word, std::string& why) {
  const std::string name = stl::lower_case(word);
  std::vector<const Command*> found;
  for (const Command& command : commands()) {
    if (name == command.name || name == command.short_form) return &command;
    if (command.name.starts_with(name)) found.push_back(&command);
  }
  if (found.size() == 1) return found[0];
  if (found.empty()) {
    std::vector<std::string_view> names;
    for (const Command& command : commands()) names.push_back(command.name);
    const std::string_view meant = nearest(name, names);
    why = meant.empty() ? fmt::format("unknown command '{}'; 'help' lists them", stl::shortened(word))
                        : fmt::format("unknown command '{}'; did you mean {}?", stl::shortened(word), meant);
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
  go({.goal = goal::instructions(*count), .show = Show::All});
  return {};
}

Debugger::Error Debugger::over(const Arguments& arguments) {
  if (!arguments.empty()) return no_argument("over");
  go({.goal = goal::over(simulation().cpu().state()), .show = Show::Started});
  return {};
}

Debugger::Error Debugger::out(const Arguments& arguments) {
  if (!arguments.empty()) return no_argument("out");
  const State& now = simulation().cpu().state();
  if (now.mode == Mode::Run && !goal::is_in_routine(now)) {
    out_ << "this is the main program, in no subroutine and no interrupt routine; 'scan' runs to the next scan\n";
    return {};
  }
  go({.goal = goal::out(now)});
  return {};
}

Debugger::Error Debugger::network(const Arguments& arguments) {
  if (!arguments.empty()) return no_argument("network");
  go({.goal = goal::network_over(simulation().cpu().state(), listing())});
  return {};
}

Debugger::Error Debugger::interrupt(const Arguments& arguments) {
  const auto ends = wants_end(arguments);
  if (!ends) return expects("interrupt", kBeginsOrEnds);
  const Cpu& cpu = simulation().cpu();
  go({.goal = *ends ? goal::interrupt_ends(cpu.state()) : goal::interrupt_begins(cpu.program())});
  return {};
}

Debugger::Error Debugger::scan(const Arguments& arguments) {
  const auto count = parse_count(arguments);
  if (!count) return expects("scan", "how many scans, for example: scan 3");
  go({.goal = goal::scan(simulation().cpu().state(), *count)});
  return {};
}

Debugger::Error Debugger::continue_run(const Arguments& arguments) {
  Run run{.goal = goal::none(), .stop_at_answer = true, .of_all = true};
  Arguments words = arguments;
  run.to_scan_end = !words.empty() && stl::lower_case(words.back()) == "scan";
  if (run.to_scan_end) words.pop_back();
  if (!words.empty()) {
    const auto time = parse_duration(joined(words));
    if (!time || *time == 0)
      return expects("continue", fmt::format("a duration above 0 in {}, and scan if it is to go on to the end of the scan, "
                                             "for example: continue 250ms, continue 1s scan",
                                             kTimeUnits));
    run.limit = *time;
  }
  go(run);
  return {};
}

Debugger::Error Debugger::until(const Arguments& arguments) {
  std::string why;
  const auto target = find_place(arguments, "until", why);
  if (!target) return why;
  go({.goal = goal::place(*target)});
  return {};
}

// --- where to stop ---

/// A place that a command names; nothing, and `why`, when there is no such place.
std::optional<std::uint32_t> Debugger::find_place(const Arguments& arguments, std::string_view command, std::string& why) {
  const auto place = tools::find_place(arguments, simulation().cpu().program(), listing(), command, why);
  if (!place) return {};
  out_ << place->note;
  return place->op;
}

// --- looking ---

Debugger::Error Debugger::list(const Arguments& arguments) {
  const auto mark = [this](std::uint32_t op) { return mark_of(op); };
  if (arguments.empty()) {
    out_ << listing().around(listing().line_of(current_op().value_or(0)), kListedBefore, kListed, mark);
    return {};
  }
  if (const auto line = parse_decimal<std::uint32_t>(joined(arguments))) {
    if (*line > listing().last_line()) return fmt::format("the last instruction is in line {}", listing().last_line());
    out_ << listing().around(*line, kListedBefore, kListed, mark);
    return {};
  }
  std::string why;
  const auto op = find_place(arguments, "list", why);
  if (!op) return why;
  out_ << listing().around(listing().line_of(*op), 0, kListed, mark);
  return {};
}

Debugger::Error Debugger::registers(const Arguments& arguments) {
  if (!arguments.empty()) return no_argument("regs");
  say_without_power();
  out_ << registers_text(simulation().cpu(), listing());
  return {};
}

Debugger::Error Debugger::stack(const Arguments& arguments) {
  if (!arguments.empty()) return no_argument("stack");
  out_ << stack_text(simulation().cpu().state());
  return {};
}

/// An address, or the one that a pointer holds now, which is said.
std::optional<Debugger::Named> Debugger::find_range(const std::string& text, std::string& why) {
  const Cpu& cpu = simulation().cpu();
  const auto place = parse_place(text, cpu.program(), why);
  if (!place) return {};
  const auto range = range_now(*place, cpu);
  const std::string written = stl::upper_case(text);
  if (!range) {
    const std::string address = name_of(place->range, place->range.name_of(0));
    why = bad_pointer_text(cpu, place->range, written, address);
    return {};
  }
  if (!place->pointer) return Named{*range, name_of(*range, written)};
  const std::string count = range->count > 1 ? fmt::format(":{}", range->count) : "";
  const Named named{*range, name_of(*range, range->name_of(0) + count)};
  out_ << fmt::format("{} is {} now\n", written, named.name);
  return named;
}

Debugger::Error Debugger::ranges_of(const Arguments& arguments, std::string_view command, std::vector<Named>& ranges) {
  for (const std::string& text : arguments) {
    std::string why, no_expression;
    const auto range = find_range(text, why);
    if (!range && arguments.size() > 1 && Expression::parse(joined(arguments), simulation().cpu().program(), no_expression))
      return fmt::format("{} takes addresses; 'print {}' computes an expression", command, joined(arguments));
    if (!range) return why;
    ranges.push_back(*range);
  }
  return {};
}

Debugger::Error Debugger::display(const Arguments& arguments) {
  if (arguments.size() == 1 && stl::lower_case(arguments[0]) == "off") {
    displayed_.clear();
    return {};
  }
  std::vector<Named> added;
  if (Error error = ranges_of(arguments, "display", added)) return error;
  for (const Named& one : added) displayed_.push_back({focus(), one.range});
  if (displayed_.empty()) out_ << "nothing is displayed; 'display VW100' adds to it\n";
  for (const auto& [station, range] : displayed_) out_ << said_of(station) << memory_text(station, range);
  return {};
}

Debugger::Error Debugger::port(const Arguments& arguments) {
  if (!arguments.empty()) return no_argument("port");
  say_without_power();
  out_ << port_text(simulation());
  for (const auto& [name, poller] : history_.pollers())
    if (simulation().has_master() && poller->is_on(simulation().line().line()))
      out_ << fmt::format("           (the master of 'send'; {} asks by itself)\n", stl::printable(name));
  return {};
}

Debugger::Error Debugger::errors(const Arguments& arguments) {
  if (!arguments.empty()) return no_argument("errors");
  const std::string text = errors_text(simulation().cpu());
  out_ << (text.empty() ? "no errors\n" : text);
  return {};
}

Debugger::Error Debugger::trace(const Arguments& arguments) {
  const std::string word = arguments.size() == 1 ? stl::lower_case(arguments[0]) : "";
  if (word != "on" && word != "off") return expects("trace", "on or off");
  tracing_ = word == "on";
  traces_follow_ = false;
  let_traces_follow();
  for (Station& station : stations_) station.trace_lines.begin_way();
  return {};
}

Debugger::Error Debugger::layout(const Arguments& arguments) {
  const std::string word = arguments.size() == 1 ? stl::lower_case(arguments[0]) : "";
  if (word != "on" && word != "off") return expects("layout", "on or off");
  if (!layout_.turn) return "layout needs a terminal";
  return layout_.turn(word == "on");
}

std::string Debugger::commands_help() {
  std::string text;
  for (const Command& command : commands())
    text += fmt::format("{:<3} {:<33}  {}\n", command.short_form, command.syntax, command.meaning);
  return text.append(kAboutCommands);
}

Debugger::Error Debugger::help(const Arguments& arguments) {
  if (arguments.empty()) {
    out_ << stl::wrapped(commands_help(), stl::kUsualWidth);
    return {};
  }
  std::string why;
  const Command* command = find_command(arguments[0], why);
  if (!command) return why;
  out_ << fmt::format("{}\n  {}\n", command->syntax, command->meaning);
  for (std::string_view rest = command->more; !rest.empty();) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    out_ << fmt::format("  {}\n", rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  if (command->takes == Takes::Faults) out_ << stl::wrapped(fault_kinds_text(), stl::kUsualWidth);
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
  if (Error error = without_power(inputs_only ? "input" : "set")) return error;
  std::vector<Assignment> assignments;
  for (const std::string& text : assignments_of(arguments)) {
    std::string why;
    const auto assignment = parse_assignment(text, simulation().cpu().program(), why);
    if (!assignment) return why;
    if (std::string refused = not_settable(assignment->place); !refused.empty()) return refused;
    if (inputs_only && assignment->place.area != Area::I)
      return fmt::format("'{}' is not an input; 'input' expects for example I0.3=1, and 'set' writes other memory",
                         stl::shortened(text));
    assignments.push_back(*assignment);
  }
  act(SetMemory{assignments});
  for (const Assignment& assignment : assignments)
    if (const std::string forced = forced_text(simulation().cpu(), {bits_of(assignment.place)}); !forced.empty())
      out_ << fmt::format("{} keeps what is forced until 'unforce {}':{}\n", assignment.place.name_of(0),
                          assignment.place.name_of(0), forced);
  const auto is_input = [](const Assignment& a) { return a.place.area == Area::I; };
  if (std::any_of(assignments.begin(), assignments.end(), is_input) && standing_at(simulation().cpu().state()))
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

Debugger::Error Debugger::mode(const Arguments& arguments) {
  if (Error error = without_power("mode")) return error;
  std::string why;
  const auto set = mode_of(joined(arguments), simulation(), why);
  if (!set) return why;
  act(*set);
  note_going_elsewhere();
  show_place();
  return {};
}

/// The request is that of the station that it was sent at.
Debugger::Error Debugger::cancel_request() {
  std::string why;
  const auto cancel = cancel_of(simulation(), why);
  if (!cancel) return "send cancel: " + why;
  const std::string text = cancelled_text(*cancel, simulation());
  act(*cancel, station_of_request());
  out_ << text;
  return {};
}

/// The last at which a frame was sent on the line of the one that it looks at.
std::size_t Debugger::station_of_request() const {
  for (std::size_t number = history_.now().actions; number > 0;) {
    const Action* const action = history_.action(--number);
    if (!action) break;
    if (!std::holds_alternative<SendFrame>(*action)) continue;
    const std::size_t station = history_.station_of_action(number);
    if (&stations_[station].simulation->line() == &simulation().line()) return station;
  }
  return focus();
}

Debugger::Error Debugger::send(const Arguments& arguments) {
  if (arguments.size() == 1 && stl::lower_case(arguments[0]) == "cancel") return cancel_request();
  constexpr std::uint8_t kStation = 1;  // unless another one is named
  if (arguments.empty() || (arguments.size() == 1 && stl::lower_case(arguments[0]) == "crc"))
    return expects("send",
                   "a frame in hex, text in quotation marks, or a request, for example: send 01 03 00 00 00 02 crc, send "
                   "'HELLO\\r', or send read 40011:2");
  std::string why;
  const auto frame = parse_frame(joined(arguments), kStation, why);
  if (!frame) return fmt::format("send {}: {}", joined(arguments), why);
  const auto send = send_of(*frame, simulation(), master(focus()), why);
  if (!send) return "send: " + why;
  act(*send);
  out_ << sent_text(*send, simulation()) << other_master_text(history_, focus());
  if (!simulation().plc().powered()) out_ << without_power_text(name_of(focus())) << '\n';
  return {};
}

Debugger::Error Debugger::fault(const Arguments& arguments) {
  if (arguments.empty()) {
    out_ << faults_text(history_, focus());
    return {};
  }
  std::string why;
  const auto inject = fault_of(joined(arguments), history_, focus(), why);
  if (!inject) return why;
  act(*inject, focus());
  out_ << fault_text(*inject);
  return {};
}

}  // namespace s7200::tools
