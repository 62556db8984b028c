// The command language of `s7200 debug`: line in, text out.
//
// Every moment of the past can be reached again (history.hpp), and a command that ran something can be taken back.
// Commands that only look change nothing, and neither does stepping: the program does what it does in one go.
//
// Of the stations of a system it looks at one, with which steps and addresses are concerned; all of them run.
#pragma once

#include <atomic>
#include <deque>
#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "interpreter/base/wrapped.hpp"
#include "interpreter/trace/trace_lines.hpp"
#include "serial_sim/modbus/request.hpp"
#include "serial_sim/peers/requester.hpp"
#include "serial_sim/system/simulation.hpp"
#include "tools/host/host_time.hpp"
#include "tools/host/written_files.hpp"
#include "tools/session/causes/last_decision.hpp"
#include "tools/session/causes/writer.hpp"
#include "tools/session/commands/print_forms.hpp"
#include "tools/session/commands/session_file.hpp"
#include "tools/session/observers/last_executions.hpp"
#include "tools/session/past/access.hpp"
#include "tools/session/past/history.hpp"
#include "tools/session/stops/stepper.hpp"
#include "tools/session/stops/words.hpp"
#include "tools/views/listing.hpp"

namespace s7200::tools {

/// A PLC of a system.
struct DebuggedStation {
  std::string name;
  serial::MasterSettings master{};  ///< how `send` talks on its line
};

struct DebuggerOptions {
  serial::MasterSettings master{};                  ///< how `send` talks
  std::vector<DebuggedStation> stations{};          ///< of a system, which says itself how; none: one PLC without a name
  std::size_t station = 0;                          ///< that it looks at first
  const std::atomic<bool>* stop_request = nullptr;  ///< ends a run when it becomes true; may be set by a signal handler
  History::Settings history{};                      ///< with the records, which watch the CPU too
  /// Why a run has ended by itself, such as a bridge that has failed: said once, empty otherwise. The next one goes on.
  std::function<std::string()> take_failure = [] { return std::string(); };
  /// Ends a run that follows the clock when it becomes true, so that what was typed meanwhile can be carried out; null if
  /// nobody types.
  std::atomic<bool>* pause = nullptr;
  std::string files{};  ///< that the records and captures write: "the trace"; "" for none
  bool colour = false;  ///< what is forced, and errors, are shown in red, stops in bold, trouble of a trace in yellow
  std::size_t width = stl::kUsualWidth;  ///< of the lines of a timeline
  /// Shows how far a long command has come, in place of what it showed before; "" takes that away. None: nothing is shown.
  std::function<void(std::string_view text)> progress{};
  Time patience = 2 * kSecond;              ///< of the host: how long a command runs before it is shown
  WrittenFiles written{};                   ///< that are read and written already
  std::vector<SessionOption> conditions{};  ///< options that a saved session needs again, besides the master's

  /// Writes a session as a scenario. Returns what was left out, and why that cannot be recorded; nothing, and `why`, if
  /// nothing of it can.
  std::function<std::optional<std::vector<std::string>>(const SessionRecord& record, const Destination& to,
                                                        std::string& why)>
      write_scenario{};
};

struct ScriptError {
  std::size_t line = 0;
  std::string message;
};

class Debugger {
 public:
  static constexpr std::string_view kPrompt = "(s7200) ";
  static constexpr std::size_t kKeptStates = 64;
  static constexpr Time kDefaultLimit = 10 * kSecond;

  /// A message when a command is wrong: what was expected.
  using Error = std::optional<std::string>;

  /// The list of all commands, and what is worth knowing of them, in lines of any length.
  static std::string commands_help();

  /// The simulation has been powered up; `restart` goes back to how it is now. Both must live as long as this.
  Debugger(serial::Simulation& simulation, std::ostream& out, const DebuggerOptions& options);
  /// The same of a system, seen from each of its PLCs, in their order.
  Debugger(const std::vector<serial::Simulation*>& stations, std::ostream& out, const DebuggerOptions& options);

  /// Runs a recording instead of what has run, and goes to a moment of it. False if it does not come to its end here.
  /// `failed`: memory that was not as expected there, which `why` is about as long as it stands there.
  bool open(Recording recording, const Moment& at, const std::vector<MemoryRange>& failed = {});

  /// Where it stands, and what is displayed.
  void show_place();

  /// One line: commands separated by `;`, a comment after `//`, or after `#` at its beginning. Ends with the first wrong
  /// one. After a stop request the rest is not done, which is said.
  Error execute(std::string_view line);

  /// Executes line by line, each command echoed after the prompt, to the first wrong one, to `quit`, to a stop request or
  /// the end. After a stop request it says how many commands were left: up to the end of the script if it is there as a
  /// whole, of a pipe up to the end of the line.
  std::optional<ScriptError> run_script(std::istream& in, bool is_whole = true);

  /// What the word that ends `line` may become: commands, addresses and symbols, places, files. It is `word` long.
  struct Offers {
    std::size_t word = 0;
    std::vector<std::string> candidates{};
  };
  Offers completions(std::string_view line) const;

  /// Who shows view() steadily, and hears what is typed while a run goes on. Without it there is neither.
  struct Layout {
    std::function<Error(bool on)> turn{};  ///< switches it on or off, and returns why that cannot be
    std::function<bool()> shown{};
    std::function<void()> refresh{};  ///< called often while a run goes on
    /// A line that was typed while a run goes on; nothing if there is none. Asked often, while it follows the clock.
    std::function<std::optional<std::string>()> typed{};
  };
  void set_layout(Layout layout) { layout_ = std::move(layout); }

  /// Where it stands, the instructions around with power flow and operands, and the memory that is displayed: up to `rows`
  /// lines. While a run goes on they are the instructions around the place where it began, as they were executed last.
  std::vector<std::string> view(std::size_t rows);

  /// As what is wrong is shown on a terminal that is to have colours.
  std::string red(std::string text) const { return painted(std::move(text), Paint::Red); }

  bool quit_asked() const { return quit_asked_; }

  /// Whether the last command was an 'expect' that did not hold: it was no wrong one.
  bool expectation_failed() const { return expectation_failed_; }

  /// Where it stands, things have happened after that.
  bool in_the_past() const { return history_.in_the_past(); }

  /// The last line, if it makes sense to give it again: `step`, `over`, `continue` … Empty otherwise.
  const std::string& repeatable() const { return repeatable_; }

 private:
  using Arguments = std::vector<std::string>;

  struct Named {
    MemoryRange range;
    std::string name;
  };

  /// What belongs to one PLC.
  struct Station {
    explicit Station(serial::Simulation& its_simulation)
        : simulation(&its_simulation),
          listing(its_simulation.cpu().program()),
          trace_lines(its_simulation.cpu().program()) {}

    serial::Simulation* simulation;
    Listing listing;
    TraceLines trace_lines;
    std::optional<std::uint32_t> last_op{};  ///< executed last
  };

  std::size_t focus() const { return stepper_.looks_at(); }
  serial::Simulation& simulation() { return *stations_[focus()].simulation; }
  const serial::Simulation& simulation() const { return *stations_[focus()].simulation; }
  const Listing& listing() const { return stations_[focus()].listing; }
  bool is_system() const { return !options_.stations.empty(); }
  const serial::MasterSettings& master(std::size_t station) const {
    return is_system() ? options_.stations[station].master : options_.master;
  }

  // Lines of commands, runs, and what is said meanwhile (debugger.cpp).
  Error execute_line(std::string_view line);
  Error execute_one(std::string_view text);
  void report_undone();
  void show_progress();
  void hide_progress();

  /// What may take long: how far it has come is shown meanwhile.
  auto at_length(const auto& work) {
    if (options_.progress) progress_at_ = host_time() + options_.patience;
    auto result = work();
    hide_progress();
    return result;
  }
  bool stop_requested() const;

  /// Which executed instructions a run shows.
  enum class Show : std::uint8_t { None, Started, All };
  struct Run {
    Stepper::Goal goal;
    Time limit = kDefaultLimit;  ///< from now on
    bool stop_at_answer = false;
    Show show = Show::None;
    bool of_all = false;       ///< of all stations, and not of the one that it looks at
    bool to_scan_end = false;  ///< after the limit it goes on to the end of the scan
  };
  void go(const Run& run);
  std::optional<Stop> run_through(const Run& run);
  bool carry_out_typed();
  void go_back(const Stepper::Goal& goal, std::uint64_t count, bool stop_at_answer = false);
  void act(Action action) { act(std::move(action), focus()); }
  void act(Action action, std::size_t station);
  void remember();
  void note_going_elsewhere();
  void let_traces_follow();
  void note_new_branch();
  void note_the_past();
  void report(const Stop& stop, const Run& run, std::uint64_t errors);
  void report_reason(const Stop& stop, const Run& run);
  std::string within_scan_text(const Run& run) const;
  void report_cpu_stop();
  void report_standstill();
  void print_answer(std::size_t station, const serial::Exchange& exchange);
  void print_unasked(const SentByPlc& sent);
  void print_trace(std::size_t station, const TraceRecord& record);
  void print_trace_lines(std::size_t station, const std::vector<TraceLine>& lines);
  void write_trace(Time until);
  void write_trace_line(const TraceLine& line);
  void print_instruction(std::size_t station, const InstructionRecord& record, bool started_at);
  std::string op_text(std::uint32_t op) const { return op_text(listing(), op); }
  static std::string op_text(const Listing& listing, std::uint32_t op);  ///< `INT 123 line 40: MOVB SMB2, VB1 // …`
  std::optional<std::uint32_t> current_op() const;
  std::string memory_text(std::size_t station, const MemoryRange& range) const;  ///< with what of it is forced
  enum class Paint : std::uint8_t { Red, Yellow, Bold };
  static std::string_view escape_of(Paint paint);
  std::string painted(std::string text, Paint paint) const;  ///< on a terminal that is to have colours
  std::string bold(std::string text) const { return painted(std::move(text), Paint::Bold); }

  // The table of the commands, and those that run forwards, look at the PLC or do something to it (debugger_commands.cpp).
  /// What the words after a command may become.
  enum class Takes : std::uint8_t {
    Nothing,
    Addresses,
    Writers,  ///< what has a last write, or an attachment
    Break,
    Watch,
    Forced,     ///< what can be forced
    ForcedNow,  ///< what is forced
    Places,
    Files,
    Sessions,
    Faults,
    Commands,
    Moments,
    Power,
    Stations
  };
  struct Command {
    std::string_view name, short_form, syntax, meaning, more;
    Error (Debugger::*run)(const Arguments& arguments);
    Takes takes = Takes::Nothing;
    bool repeats = false;
    std::string_view words = "";  ///< besides, that the first of them may be
  };
  static const std::vector<Command>& commands();
  static const Command* find_command(std::string_view word, std::string& why);
  Error step(const Arguments& arguments);
  Error over(const Arguments& arguments);
  Error out(const Arguments& arguments);
  Error network(const Arguments& arguments);
  Error interrupt(const Arguments& arguments);
  Error scan(const Arguments& arguments);
  Error continue_run(const Arguments& arguments);
  Error until(const Arguments& arguments);
  Error list(const Arguments& arguments);
  Error registers(const Arguments& arguments);
  Error stack(const Arguments& arguments);
  Error display(const Arguments& arguments);
  Error port(const Arguments& arguments);
  Error errors(const Arguments& arguments);
  Error trace(const Arguments& arguments);
  Error layout(const Arguments& arguments);
  Error help(const Arguments& arguments);
  Error quit(const Arguments& arguments);
  Error set(const Arguments& arguments);
  Error input(const Arguments& arguments);
  Error mode(const Arguments& arguments);
  Error send(const Arguments& arguments);
  Error fault(const Arguments& arguments);
  Error cancel_request();
  std::size_t station_of_request() const;
  Error assign_all(const Arguments& arguments, bool inputs_only);
  std::optional<std::uint32_t> find_place(const Arguments& arguments, std::string_view command, std::string& why);
  std::optional<Named> find_range(const std::string& text, std::string& why);
  Error ranges_of(const Arguments& arguments, std::string_view command, std::vector<Named>& ranges);

  // The variables of blocks (debugger_local_variables.cpp).
  Error with_local_variables(Arguments& words, std::optional<std::uint32_t> op);

  // What a word may become (debugger_completion.cpp).
  static Arguments command_names();
  Arguments words_after(const Command& command, const Arguments& given, std::string_view last) const;

  // Where to stop (debugger_stops.cpp).
  Error set_break(const Arguments& arguments);
  Error watch(const Arguments& arguments);
  Error delete_stop(const Arguments& arguments);
  void list_stops();
  std::string mark_of(std::uint32_t op) const;
  std::optional<StopPoint> stop_of(const Arguments& words, std::string& why);
  std::vector<SessionFile::SavedStop> saved_stops() const;
  std::optional<StopPoint> stop_of(const SessionFile::SavedStop& saved, std::string& why) const;
  std::optional<std::vector<StopPoint>> stops_of(const SessionFile& file, std::string& why) const;
  std::size_t add_loaded(std::vector<StopPoint> stops);
  void report_hits(const Stop& stop);
  void report_breakpoint(const Hit& hit);
  std::string asked_by(const Hit& hit) const;
  void report_access(const Hit& hit);
  void report_changer(const Hit& hit);
  void report_uncounted();
  void print_message(const StopPoint& stop, const Hit& hit);
  static std::string value_of(const Cpu& cpu, const MemoryRange& range);

  // Back in time, and what has happened (debugger_past.cpp).
  Error back(const Arguments& arguments);
  Error back_step(const Arguments& arguments);
  Error back_over(const Arguments& arguments);
  Error back_out(const Arguments& arguments);
  Error back_network(const Arguments& arguments);
  Error back_interrupt(const Arguments& arguments);
  Error back_scan(const Arguments& arguments);
  Error back_continue(const Arguments& arguments);
  Error back_until(const Arguments& arguments);
  Error at(const Arguments& arguments);
  Error who(const Arguments& arguments);
  Error back_to_write(const Arguments& arguments);
  Error why(const Arguments& arguments);
  Error back_to_decision(const Arguments& arguments);
  Error history(const Arguments& arguments);
  Error timeline(const Arguments& arguments);
  Error fork(const Arguments& arguments);
  Error past(const Arguments& arguments);
  Error restart(const Arguments& arguments);
  void go_to(const Moment& moment);
  std::optional<Named> one_range(const Arguments& arguments, std::string_view command, std::string& why);
  std::optional<Writer> reported(const WriterSearch& search, const std::vector<Bits>& places);
  std::optional<Writer> report_writer(const MemoryRange& range, std::string_view name);
  std::optional<Writer> report_attachment(std::uint8_t event);
  Error report_writer_of(const Arguments& arguments, std::string_view command, std::optional<Writer>& writer);
  DecisionSearch find_decision();
  Error report_cause(const MemoryRange& range, std::string_view name);
  bool report_failed();

  // Memory and expressions (debugger_print.cpp).
  Error print(const Arguments& arguments);
  Error expect(const Arguments& arguments);
  void note_looked_at(const Place& place);
  void print_place(const Place& place, const std::string& name, const PrintForm* form);
  void print_bad_pointer(const std::string& name, const MemoryRange& pointer);
  void print_bad_pointers(std::uint32_t op);
  std::string name_of(const MemoryRange& range, std::string_view written) const;
  static std::string name_of(const MemoryRange& range, std::string_view written, const Program& program);

  // The program with what it last did (debugger_status.cpp).
  Error status(const Arguments& arguments);
  std::vector<std::string> status_lines(std::uint32_t first, std::uint32_t end, const LastExecutions& last);
  LastExecutions last_executions_of(std::uint32_t first, std::uint32_t end);
  std::vector<Bits> operands_of(std::uint32_t op) const;
  bool is_in_view() const { return layout_.shown && layout_.shown(); }
  std::pair<std::uint32_t, std::uint32_t> ops_in_view() const;
  void begin_live_status();
  void note_live_status(const InstructionRecord& record);

  // What is forced (debugger_forcing.cpp).
  Error force(const Arguments& arguments);
  Error unforce(const Arguments& arguments);
  std::string forced_text(const Cpu& cpu, const std::vector<Bits>& places) const;  ///< `  forced: VW10=5`, or nothing

  // The stations of a system (debugger_stations.cpp).
  Error station(const Arguments& arguments);
  const LineStation* without_program(std::string_view name) const;
  void look_at(std::size_t station);
  Error without_power(std::string_view command) const;
  void say_without_power();
  std::string name_of(std::size_t station) const;
  std::string said_of(std::size_t station) const;  ///< `slave: `; nothing if there is but one PLC
  std::string place_line(std::size_t station) const;
  std::uint64_t errors_of_all() const;

  // Sessions in files, and power (debugger_session.cpp).
  Error save(const Arguments& arguments);
  Error load(const Arguments& arguments);
  Error record(const Arguments& arguments);
  Error power(const Arguments& arguments);
  Error switch_power(bool on);
  std::vector<SessionOption> session_conditions() const;
  std::optional<Destination> destination(const Arguments& arguments, std::string_view command, FileKind kind,
                                         Replace unasked, std::string& why) const;
  SessionFile session_file() const;
  bool has_come_to(const SessionFile& file) const;
  std::optional<serial::Exchange> last_exchange() const;
  std::string requests_under_way();
  SessionRecord::Station record_of(std::size_t station) const;
  std::vector<SessionRecord::LookedAt> looked_at_here();
  std::optional<std::size_t> station_at_host(std::size_t host) const;

  struct Kept {
    std::string command;
    History::Place place;
    std::size_t station = 0;  ///< that it looked at
  };

  /// Memory of a station.
  struct Displayed {
    std::size_t station = 0;
    MemoryRange range{};
  };

  /// Memory that was printed or expected.
  struct LookedAt {
    std::size_t station = 0;
    Moment moment;
    MemoryRange range{};
    std::vector<std::uint8_t> bytes{};
  };

  /// An expectation that did not hold.
  struct FailedExpectation {
    std::size_t station = 0;
    Moment moment;
    std::vector<MemoryRange> memory{};
  };

  /// A run-time error of a station.
  struct StationError {
    std::size_t station = 0;
    TraceRecord record{};
  };

  std::ostream& out_;
  DebuggerOptions options_;
  History history_;
  Stepper stepper_;
  std::deque<Station> stations_;
  std::size_t name_width_ = 0;            ///< of the longest
  std::vector<TraceLine> trace_waiting_;  ///< of a system: others may come before them
  std::deque<Kept> kept_;                 ///< newest last
  std::vector<Displayed> displayed_;
  std::vector<LookedAt> looked_at_;          ///< since the last power-up, on whatever branch
  FailedExpectation failed_{};               ///< the last one
  std::optional<StationError> first_error_;  ///< of the run under way
  Show show_ = Show::None;
  std::size_t unasked_ = 0;  ///< transmissions of the run under way
  int next_number_ = 1;      ///< of a breakpoint or watch
  bool tracing_ = false;
  bool traces_follow_ = false;  ///< they have been told all that was before where it stands
  bool quit_asked_ = false;
  bool expectation_failed_ = false;
  std::size_t undone_ = 0;  ///< commands, after a stop request
  bool echoing_ = false;    ///< commands are printed after the prompt
  std::string command_;     ///< being executed, as written
  std::string repeatable_;
  Time progress_at_ = kNever;  ///< of the host: when progress is shown next
  bool progress_shown_ = false;
  Layout layout_{};
  bool is_typed_to_ = false;            ///< a run goes on that follows the clock: what is typed is carried out
  std::optional<std::string> typed_{};  ///< a line that waits for that

  /// What is in view while a run goes on.
  struct LiveStatus {
    std::uint32_t first = 0, end = 0;
    LastExecutions last{};
  };
  std::optional<LiveStatus> live_status_;
};

}  // namespace s7200::tools
