#include "tools/session/commands/rows/command_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "interpreter/base/text/nearest.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/base/text/wrapped.hpp"
#include "interpreter/model/instruction.hpp"
#include "tools/session/commands/memory_words.hpp"
#include "tools/session/commands/rows/commands.hpp"
#include "tools/session/words/print_forms.hpp"
#include "tools/session/words/words.hpp"
#include "tools/views/state/faults.hpp"
#include "tools/views/text_frame.hpp"

namespace s7200::tools {
namespace {

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

constexpr std::string_view kBlanks = " \t\r";

/// Where the character at `place` ends, or the quotation that begins a word there.
std::size_t end_of_piece(std::string_view text, std::size_t place) {
  const bool begins_a_word = place == 0 || stl::is_blank(text[place - 1]);
  const std::size_t quotation = begins_a_word ? quotation_length(text.substr(place)) : 0;
  return quotation == std::string_view::npos ? text.size() : place + std::max<std::size_t>(quotation, 1);
}

/// `//` begins one in front of any word, `#` only at the beginning of a line: #name is a variable of a block. `# ` is none
/// of those.
bool begins_comment(std::string_view line, std::size_t place) {
  if (place > 0 && !stl::is_blank(line[place - 1])) return false;
  if (line.substr(place).starts_with("//")) return true;
  const bool first = line.substr(0, place).find_first_not_of(kBlanks) == std::string_view::npos;
  const bool alone = place + 1 == line.size() || stl::is_blank(line[place + 1]);
  return line[place] == '#' && (first || alone);
}

std::string_view without_comment(std::string_view line) {
  for (std::size_t i = 0; i < line.size(); i = end_of_piece(line, i))
    if (begins_comment(line, i)) return line.substr(0, i);
  return line;
}

/// Quotations are not split.
std::vector<std::string> split(std::string_view text, std::string_view separators) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0, end = 0; begin < text.size(); begin = end = end + 1) {
    while (end < text.size() && separators.find(text[end]) == std::string_view::npos) end = end_of_piece(text, end);
    if (end > begin) parts.emplace_back(text.substr(begin, end - begin));
  }
  return parts;
}

Reply help(Session& session, const Words& arguments) {
  if (arguments.empty()) {
    session.said << stl::wrapped(commands_help(), stl::kUsualWidth);
    return {};
  }
  const auto command = find_command(arguments[0]);
  if (!command) return wrong(command.why());
  session.said << fmt::format("{}\n  {}\n", command->syntax, command->meaning);
  for (std::string_view rest = command->more; !rest.empty();) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    session.said << fmt::format("  {}\n", rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  if (command->takes == Takes::Faults) session.said << stl::wrapped(fault_kinds_text(), stl::kUsualWidth);
  if (!command->short_form.empty()) session.said << fmt::format("  short: {}\n", command->short_form);
  return {};
}

/// Where it stands now is not where it stood.
bool has_moved(const History::Place& before, const History::Place& now) {
  return now.branch != before.branch || now.moment.instructions != before.moment.instructions ||
         now.moment.time != before.moment.time;
}

}  // namespace

const std::vector<CommandRow>& command_table() {
  static const std::string kPrintSyntax = fmt::format("print [{}] ADDRESS… | EXPRESSION", print_forms_text(" | "));
  static const std::string kPrintWords = print_forms_text(" ");
  static const std::string kAboutPrint = print_forms_meanings() + std::string(kMoreAboutPrint);
  static const std::vector<CommandRow> kTable{
      {"step", "s", "step [n]", "execute one instruction, or n, going into CALL and interrupt routines",
       R"(Each executed instruction is shown with its operands (inputs before it, results after it), S0 after it, and its
time. For example: break INT 123; continue; step 5.)",
       commands::step, Takes::Nothing, true},
      {"over", "o", "over", "execute one instruction; a CALL with all that it calls, interrupts in between too",
       "Breakpoints and watches inside still stop. For example: break 83; continue; over.", commands::over, Takes::Nothing,
       true},
      {"out", "u", "out", "run to the end of the subroutine or interrupt routine", "", commands::out, Takes::Nothing, true},
      {"network", "nw", "network", "run to the next network of this routine; a CALL with all that it calls, as 'over'", "",
       commands::network, Takes::Nothing, true},
      {"interrupt", "int", "interrupt [begins | ends]", "run until the next interrupt routine begins, or the next one ends",
       "It stands in front of its first instruction, or in front of the first one after it.", commands::interrupt,
       Takes::Nothing, true, "begins ends"},
      {"scan", "n", "scan [n]", "run to the start of the next scan's program, or of the nth",
       "For example: input I0.3=1; scan 2; print Q0.0.", commands::scan, Takes::Nothing, true},
      {"continue", "c", "continue [TIME] [scan]",
       "run until a breakpoint, a watch, an answer, STOP, or TIME has passed (10 s)",
       R"(TIME is simulated, in ns, us, ms, s, min or h: 250ms, 1.5s, 20min. The run ends before the first instruction after
that time, which is mostly within a scan; with 'scan' it goes on to the end of that scan, where the outputs are written.
Ctrl-C stops it too. With a bridge, --realtime or --speed commands may be typed while it runs: they are carried out at
once, and the run goes on after set, force, print and all others that do not move it.)",
       commands::continue_run, Takes::Nothing, true, "scan"},
      {"until", "t", "until LINE | SBR n | INT n | LBL n | NETWORK n | CONDITION [within TIME]",
       "run to a place, or until a condition holds",
       R"(CONDITION: until Q0.3, until not Q0.3, until T37, until VW10 > 5. If it does not come to hold within TIME (10 s) the run
stops there and says what blocks it, as 'why not' does. For example: until Q0.3 within 1min.)",
       commands::until, Takes::Goals, true, "not"},
      {"back", "k", "back [n]", "back to the state before the last command that ran something, or the last n",
       R"(The last 64 are kept. Breakpoints and watches stay. Going forward again plays what has run, with what was done to
the PLC; 'set', 'input', 'send' in the past begin a new branch.)",
       commands::back},
      {"rstep", "rs", "rstep [n]", "back by one instruction, or n, into subroutines and interrupt routines", kBackwards,
       commands::back_step, Takes::Nothing, true},
      {"rover", "ro", "rover", "back by one instruction; a CALL with all that it called, interrupts in between too",
       kBackwards, commands::back_over, Takes::Nothing, true},
      {"rout", "ru", "rout", "back to the CALL of this subroutine, or to what this interrupt routine interrupted",
       kBackwards, commands::back_out, Takes::Nothing, true},
      {"rnetwork", "rnw", "rnetwork", "back to the start of this network, or of the one before", kBackwards,
       commands::back_network, Takes::Nothing, true},
      {"rinterrupt", "ri", "rinterrupt [begins | ends]", "back to where an interrupt routine last began, or ended",
       kBackwards, commands::back_interrupt, Takes::Nothing, true, "begins ends"},
      {"rscan", "rn", "rscan [n]", "back to the start of the scan's program, then of the one before, or of the nth",
       kBackwards, commands::back_scan, Takes::Nothing, true},
      {"rcontinue", "rc", "rcontinue", "back to the last breakpoint, change of a watch, or end of an answer", kBackwards,
       commands::back_continue, Takes::Nothing, true},
      {"runtil", "rt", "runtil LINE | SBR n | INT n | LBL n | NETWORK n", "back to the last time that it was at a place",
       kBackwards, commands::back_until, Takes::Places, true},
      {"at", "", "at TIME | -TIME | start | end", "to a moment: at 15.193ms, or so long before now: at -5ms",
       R"(TIME is in ns, us, ms, s, min or h. It stands in front of the first instruction at or after it. start is the oldest
moment, which is power-up as long as nothing is forgotten, end the newest one.)",
       commands::at, Takes::Moments, false, "start end"},
      {"who", "", "who ADDRESS | event N",
       "the instruction that wrote an address last, or attached an event, without going there",
       R"(With its operands, the interrupt and the time; also if the value stayed the same. Entries of tables, strings and
messages only if they changed it. What an event of a system file has set is named as what a command has. who *VD3570
takes the address that the pointer holds now. 'rwho' goes there.)",
       commands::who, Takes::Writers, false, "event"},
      {"rwho", "rw", "rwho ADDRESS | event N", "back to in front of the instruction that 'who' names",
       "rwho event 8 goes to where the program last changed which routine gets the characters: where it dropped a frame.",
       commands::back_to_write, Takes::Writers, true, "event"},
      {"why", "", "why [ADDRESS | not CONDITION [all] | latency]",
       "what decided that it has come here: contacts, a jump or a conditional return, without going there",
       R"(With an address: who wrote it last, which contacts decided that, and so on back to an input; or which instructions
could write it, and what keeps them from it. why not Q0.3: the rungs that write it, the fewest contacts that would have to
change, with what each has, since when and who could change it; why not not Q0.3 what keeps it on, why not VW10 > 5 who
writes VW10. Of a long answer the nearest 38 lines are shown, with what to ask for more; why not Q0.3 all shows all of it.
why latency: what the last answer to a master in the simulation waited for. Where an 'expect' or a step of a scenario has
just failed, why is about the memory that was not as expected.
Without one: the contacts of this rung, or what the main program or the interrupt routine came by last, with operand values.
While a master or a program waits for an answer, and where it gives up: also what has left the request without one,
be it the program, an event that is not attached, a port in PPI mode, or the line that lost it or its answer; or that
it was for another station. That comes first, what led to this place last.)",
       commands::why, Takes::Wishes, false, "not latency all"},
      {"effect", "ef", "effect ADDRESS [at TIME] [within TIME]",
       "what came of the last change of a bit or word: what it made otherwise, and until when",
       R"(Of the last change before now, or before TIME, a moment as those of at. The known past is compared, for TIME (10 s) after
the change, with the same run in which the memory keeps its old value for as long as it had the new one. What differs is
shown below what led to it, with the instruction that wrote it and the contact that looked; what would have happened anyway
is not. A turn of a bit that comes in both runs within two scans counts as the same. For example: input I0.2=1; continue 2s;
effect I0.2, or effect VW10 at 1.5s within 500ms.)",
       commands::effect, Takes::Changes},
      {"rwhy", "ry", "rwhy", "back to in front of the instruction that 'why' names",
       R"(Of a jump or conditional return: in front of it, after the contacts that decide on it, which 'history' shows. Of
contacts: after the last of them, where S0 is what they have decided; if it stands there already, in front of
the first.)",
       commands::back_to_decision, Takes::Nothing, true},
      {"history", "", "history [n]", "the last 10 instructions before now, or n, with their operands and comments",
       "For example, what led to the end of an interrupt routine: interrupt ends; history 20.", commands::history},
      {"timeline", "", "timeline [TIME]", "what the CPU did since the last 'send', or for so long before now",
       R"(Characters, interrupts with what they waited for, XMT, and the way of the main program; in ms after the frame
began. For example: send 01 03 00 0a 00 01 crc; continue; timeline, or timeline 50ms.)",
       commands::timeline},
      {"spans", "", "spans FROM TO [COUNT] [ADDRESS…]",
       "what happened from one moment to another: characters, frames, interrupts, scans, values",
       R"(FROM and TO are moments as those of at; in a part of up to 10 s routines and networks are followed too. Of a track
with more than COUNT elements (2000) those that begin in the same part of the time are one, which says how many they are, and
how many of them are errors. For pages; the text is a summary. For example: spans -50ms end VW20 Q0.0.)",
       commands::spans, Takes::Addresses, false, "start end"},
      {"fork", "", "fork", "forget what has run after this moment: going forward is new from here on",
       "What was done to the PLC later is not done again. back takes it back.", commands::fork},
      {"past", "", "past", "how far back it can go, and what that takes", "", commands::past},
      {"actions", "", "actions [n]",
       "what was done from outside up to now, the last 50 or n: inputs, values, frames, faults",
       "That and the program are all that has led here: the same actions at the same moments lead here again.",
       commands::actions},
      {"power", "", "power [all] [TIME] [lost] | off | on",
       "switch power off and on again: the CPU begins with what it has kept",
       R"(off and on switch this PLC alone; time goes on, and going back crosses both: power off; continue 2s; power on.
power alone, or with a TIME, does both at once and begins a new branch at time 0, which back takes back. TIME is how long
it was off, in ns, us, ms, s, min or h; the clock goes on: power 8h. lost: too long for the RAM, only the EEPROM is left. Of
a system that is every PLC: power all 8h.)",
       commands::power, Takes::Power},
      {"save", "", "save FILE [!]",
       "write where this session stands, and its past; 'load' returns there, in another session too",
       R"(The file has all that was done to the PLC, and when; 'load' runs that again, which comes to the same state to
the bit. Breakpoints and watches are in it too, and count their hits anew; displays are not. It fits the same program,
CPU, execution times and version of s7200, started with the same options. An existing file is replaced if save has
written it; ! replaces any.)",
       commands::save, Takes::Files},
      {"load", "", "load FILE [!]", "go to where 'save' was given",
       R"(Its breakpoints and watches join those that are set. back returns to here, and leaves them. With ! also a session of
more than a week of simulated time, which is run again.)",
       commands::load, Takes::Sessions},
      {"restart", "", "restart", "power up again; breakpoints, watches and displays are kept",
       "A new branch: back takes it back.", commands::restart},
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
       commands::set_break, Takes::Break},
      {"watch", "w", "watch ADDRESS[:COUNT]… [read | write | read write | change] [if …] [hits N] [log …]",
       "stop after the instruction that changes M31.7, VB100, VW100, AC0 …, or reads or writes it; alone: list",
       R"(Interrupt routines too. The system changes memory as well: inputs, SM bits, SMB2 before INT of event 8. 'read' and
'write' are for instructions alone, and 'write' stops also if the value stays the same. Entries of tables, strings and
messages count only if they change. watch *VD3570 takes the address that the pointer holds now, and stays there.)",
       commands::watch, Takes::Watch},
      {"delete", "d", "delete N… | all", "remove breakpoints and watches", "", commands::delete_stop, Takes::Nothing, false,
       "all"},
      {"station", "", "station [NAME]", "the stations of a system: where each stands; or go over to another one",
       R"(PLCs first, then the peers and bridges on their lines, which have no program to step through. Steps, addresses, places
and 'send' are about one station at a time; all of them run, and breakpoints and watches stay with the station that
they were set at. What stops at another station goes over to it.)",
       commands::station, Takes::Stations},
      {"list", "l", "list [LINE | SBR n | INT n | LBL n | NETWORK n]", "the program around the current place or elsewhere",
       "> is the current line, * a breakpoint. For example: list INT 123, or list 80.", commands::list, Takes::Places},
      {"listing", "", "listing [FROM TO]", "the program as its file has it: routines and networks, or these lines",
       "FROM and TO are numbers of lines, at most 1000. For pages and editors, which get the outline with its symbols.",
       commands::listing},
      {"status", "", "status [LINE | LINE LINE | SBR n | INT n | LBL n | NETWORK n]",
       "the program with power flow and operands of each instruction's last execution",
       R"(Of the last 2 s at least. S0 is the top of the logic stack after it. For example: status NETWORK 2, or from one line
to another: status 40 60.)",
       commands::status, Takes::Places},
      {"ladder", "", "ladder [LINE | SBR n | INT n | LBL n | NETWORK n]",
       "a network as ladder, with the power flow of its last execution",
       R"(Double lines have power; below are the values that its instructions found. What was not executed in the last 2 s has none.
For example: ladder, where the program stands, or ladder NETWORK 2. In the past it draws the past.)",
       commands::ladder, Takes::Places},
      {"regs", "r", "regs", "time, place, calls, accumulators, flags, interrupts", "", commands::registers},
      {"record", "", "record FILE.yaml [!]", "write this session, up to now, as a scenario that 's7200 test' replays",
       R"(Frames, those that came over a bridge too, memory and inputs that were set, what was forced, modes, faults of the line
and power cycles, each at its time, and the answers that came, which may come up to 5 ms earlier or later ('tolerance'). What
was printed or expected is expected again where it was, and what is displayed at the end. A session without any of these
is refused: it would test nothing.
What no scenario can do is left out, and said: something set or sent while a frame or its answer was under way, a request
given up within its answer, 'goto' and the logic stack of an editor. 'power all' of a system, and a session with --memory,
cannot be recorded. A file that exists is replaced if ! follows its name.)",
       commands::record, Takes::Files},
      {"stack", "sta", "stack", "the nine levels of the logic stack", "", commands::stack},
      {"print", "p", kPrintSyntax,
       "memory: VB100:16, VW100, VD20:real, M31.7, AC0, T37, HC0, *VD3570:8, *AC1:word; or VW2 * 2 + 1", kAboutPrint,
       commands::print, Takes::Addresses, false, kPrintWords},
      {"values", "", "values [/FORM] ADDRESS[:COUNT]… [/FORM ADDRESS…]",
       "memory, one value a line, each in the form that stands before it",
       R"(The forms are those of print. What is wrong with an address stands in its place, and 'record' does not expect these
values again. For pages, which ask often. For example: values VW100 /x VB4:8 /b QB0.)",
       commands::values, Takes::Values, false, kPrintWords},
      {"expect", "", "expect EXPRESSION", "a failure unless it holds: a script with such lines is a test",
       "expect VW20 = 5 and M0.1. A script ends at the first that does not hold, with exit code 1.", commands::expect,
       Takes::Addresses},
      {"display", "", "display [ADDRESS[:COUNT]… | off]", "print memory after each stop",
       R"(Further ones are added. Alone: print them now. display *VD3570 takes the address that the pointer holds now, and
stays there.)",
       commands::display, Takes::Addresses, false, "off"},
      {"port", "", "port", "SMB30 in words, receiver, transmitter, and the master on the line",
       "For example, in the middle of a frame: send 01 03 00 0a 00 01 crc; continue 3ms; port.", commands::port},
      {"errors", "e", "errors", "run-time and fatal errors up to now", "", commands::errors},
      {"trace", "", "trace on | off", "print interrupts, characters and errors while running", "", commands::trace,
       Takes::Nothing, false, "on off"},
      {"layout", "", "layout on | off", "keep program, status and memory in view, in the upper part of a terminal",
       R"(It needs 80×24 or more. Above: where it stands, the instructions around it with their last execution, and the
memory that 'display' names, or the registers. Below: the prompt.)",
       commands::layout, Takes::Nothing, false, "on off"},
      {"set", "", "set ADDRESS=VALUE…",
       "write memory: set VW100=5 M0.3=1 VB4=16#FF VD8=&VB100; I addresses are the input points",
       "SMB28 and SMB29 are the potentiometers, SM0.7 is the mode switch; the rest of SM0.0 to SM29.7 only the CPU\n"
       "writes.",
       commands::set, Takes::Addresses},
      {"input", "i", "input I0.3=1…", "switch input points; edges of I0.0 to I0.3 cause events 0 to 7",
       "The program finds the new level when the inputs are next read, or at once with an immediate instruction.\n"
       "Analog inputs, the potentiometers SMB28 and SMB29 and the mode switch SM0.7 too: input AIW0=6400.",
       commands::input, Takes::Addresses},
      {"force", "", "force [ADDRESS=VALUE…]", "hold points of I and Q, V and M memory, AI and AQ at a value; alone: list",
       R"(As a programming device forces: force I0.3=1 Q0.0=0 VW100=5. Inputs have the value when they are read, outputs
when they are written (end of scan, immediate, STOP), memory after each program: in between the program may
change it, while print, expect and until see what is forced. Up to 16 values of memory: bytes, words, double
words; AI and AQ words. Shown in red. Edges and counters see the terminal. The CPU keeps it without power; going
back undoes it.)",
       commands::force, Takes::Forced},
      {"unforce", "", "unforce ADDRESS… | all", "release what is forced",
       "Inputs follow their terminals again, outputs their image; memory keeps what it has.", commands::unforce,
       Takes::ForcedNow, false, "all"},
      {"mode", "", "mode run | stop", "switch the CPU to RUN or STOP, as a programming device does",
       "After a fatal error only 'restart' or 'power' bring it back.", commands::mode, Takes::Nothing, false, "run stop"},
      {"send", "", "send HEX… | 'TEXT' [crc] | read ADDRESS[:COUNT] | write ADDRESS=VALUE… [station n] | cancel",
       "send a frame, with its Modbus CRC if crc is given; cancel abandons the request",
       R"(p after a byte sends it with wrong parity. TEXT is ASCII, with \r \n \t \\ \' and \xHH. 'continue' runs while it
arrives and stops when the answer is complete. After cancel a character that has begun is still sent; then the master is
ready for the next request.)",
       commands::send, Takes::Nothing, false, "read write cancel"},
      {"fault", "", "fault KIND[:PARAMETER=VALUE,…] [station=NAME] | none",
       "inject a fault on the line, or clear all faults",
       R"(As --fault of 's7200 run': fault flip:character=3,bit=5, fault noise:ber=0.001, fault cut:from=2ms. It counts
exchanges and times from now; 's7200 help faults' has all parameters. In a system station=NAME says whose characters it
strikes, as 'station' of a system file: fault parity:character=2 station=slave2. Going back undoes it. Alone: the
faults in force, and how often each has happened.)",
       commands::fault, Takes::Faults, false, "none"},
      {"help", "h", "help [COMMAND]", "this list, or more about a command", "", help, Takes::Commands},
      {"quit", "q", "quit", "end", "", commands::quit},
  };
  return kTable;
}

std::vector<std::string> command_names() {
  std::vector<std::string> names;
  for (const CommandRow& command : command_table()) names.emplace_back(command.name);
  return names;
}

/// What other debuggers call a command, and the words that are no command here.
struct OtherWord {
  std::string_view word, hint;
};
constexpr std::array kOtherWords{
    OtherWord{"run", "'continue' runs"},
    OtherWord{"go", "'continue' runs"},
    OtherWord{"start", "'restart' powers up again, 'continue' runs"},
    OtherWord{"stop", "'mode stop' switches the CPU to STOP; Ctrl-C ends a run"},
    OtherWord{"reset", "'restart' powers up again"},
    OtherWord{"next", "'over' executes a CALL with all that it calls"},
    OtherWord{"finish", "'out' runs to the end of the routine"},
    OtherWord{"up", "'regs' shows the calls"},
    OtherWord{"bt", "'regs' shows the calls"},
    OtherWord{"where", "'regs' shows the place and the calls"},
    OtherWord{"backtrace", "'regs' shows the calls"},
    OtherWord{"info", "'break', 'watch' and 'display' alone list theirs, 'regs' shows the rest"},
    OtherWord{"clear", "'delete' removes breakpoints"},
    OtherWord{"goto", "'at' goes to a moment, 'until' to a line"},
    OtherWord{"jump", "'until' runs to a line; no command skips instructions"},
    OtherWord{"brk", "'break' sets a breakpoint"},
    OtherWord{"breakpoint", "'break' sets a breakpoint, alone it lists them"},
    OtherWord{"breakpoints", "'break' alone lists them"},
    OtherWord{"tbreak", "'until' stops once"},
    OtherWord{"wait", "'continue TIME' lets time pass"},
    OtherWord{"sleep", "'continue TIME' lets time pass"},
    OtherWord{"exit", "'quit' ends"},
    OtherWord{"x", "'print VB0:16' shows memory"},
    OtherWord{"?", "'help' lists the commands"},
};

/// The hint for a word that is no command: of another debugger, or of a program.
std::string hint_for_word(std::string_view word, std::string_view meant) {
  const std::string lower = stl::lower_case(word);
  const std::string_view name = std::string_view(lower).substr(0, lower.find('/'));
  const auto other = std::ranges::find(kOtherWords, name, &OtherWord::word);
  if (other != kOtherWords.end()) return std::string(other->hint);
  if (find_instruction(stl::upper_case(word)))
    return fmt::format("{} is an instruction: 'set' changes memory, 'print' shows it", stl::upper_case(word));
  if (word.find('=') != std::string_view::npos) return fmt::format("'set {}' changes memory", stl::shortened(word));
  return meant.empty() ? "'help' lists them" : fmt::format("did you mean {}?", meant);
}

Result<const CommandRow&> find_command(std::string_view word) {
  const std::string name = stl::lower_case(word);
  std::vector<const CommandRow*> found;
  for (const CommandRow& command : command_table()) {
    if (name == command.name || name == command.short_form) return command;
    if (command.name.starts_with(name)) found.push_back(&command);
  }
  const bool of_others = std::ranges::find(kOtherWords, name, &OtherWord::word) != kOtherWords.end();
  if (found.size() == 1 && !of_others) return *found[0];
  if (found.empty() || of_others) {
    std::vector<std::string_view> names;
    for (const CommandRow& command : command_table()) names.push_back(command.name);
    const std::string_view meant = nearest(name, names);
    return trouble("unknown command '{}'; {}", stl::shortened(word), hint_for_word(word, meant));
  }
  std::string why = fmt::format("'{}' may be", stl::shortened(word));
  for (const CommandRow* command : found) why += fmt::format("{} {}", command == found.front() ? "" : ",", command->name);
  return Trouble{std::move(why)};
}

std::string commands_help() {
  std::string text;
  for (const CommandRow& command : command_table())
    text += fmt::format("{:<3} {:<33}  {}\n", command.short_form, command.syntax, command.meaning);
  return text.append(kAboutCommands);
}

std::vector<std::string> commands_in(std::string_view line) {
  std::vector<std::string> commands = split(without_comment(line), ";");
  std::erase_if(commands, [](const std::string& one) { return one.find_first_not_of(kBlanks) == std::string::npos; });
  return commands;
}

Words command_words(std::string_view command) { return split(command, kBlanks); }

Reply execute(Session& session, Words words) {
  session.expectation_failed = false;
  const auto command = find_command(words.front());
  if (!command) return wrong(command.why());
  std::string why;
  words.erase(words.begin());
  // The condition of a break is about the routine of its place; what is wrong with a value stands in the value's place.
  const bool reads_them_itself = command->takes == Takes::Break || command->takes == Takes::Values;
  if (!reads_them_itself) why = with_local_variables(session, words, session.current_op());
  if (why.empty() && !command->takes_words() && !words.empty()) why = no_argument(command->name);
  session.command = std::string(command->name) + (words.empty() ? "" : " ") + joined(words);
  const History::Place before = session.history.here();
  Reply reply = why.empty() ? command->run(session, words) : wrong(why);
  reply.text = session.take_said() + reply.text;
  reply.moved |= has_moved(before, session.history.here());
  return reply;
}

}  // namespace s7200::tools
