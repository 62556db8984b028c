#include "tools/debugger/debugger.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <istream>
#include <ostream>
#include <utility>

#include "interpreter/base/counted.hpp"
#include "interpreter/base/text.hpp"
#include "interpreter/trace/text_trace.hpp"
#include "tools/host/host_time.hpp"
#include "tools/host/interruption.hpp"
#include "tools/session/causes/two_masters.hpp"
#include "tools/session/observers/trace_of_past.hpp"
#include "tools/session/past/past_words.hpp"
#include "tools/session/stops/goals.hpp"
#include "tools/views/machine_text.hpp"
#include "tools/views/memory.hpp"
#include "tools/views/report.hpp"
#include "tools/views/text_frame.hpp"

namespace s7200::tools {
namespace {

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

/// Those of a line, which `;` separates; none of a comment.
std::vector<std::string> commands_in(std::string_view line) {
  std::vector<std::string> commands = split(without_comment(line), ";");
  std::erase_if(commands, [](const std::string& one) { return one.find_first_not_of(kBlanks) == std::string::npos; });
  return commands;
}

/// Is told what an action makes happen at once.
class Told final : public Observer {
 public:
  explicit Told(std::function<void(const TraceRecord&)> tell) : tell_(std::move(tell)) {}
  void record(const TraceRecord& record) override { tell_(record); }

 private:
  std::function<void(const TraceRecord&)> tell_;
};

History::Settings settings_of(const DebuggerOptions& options, std::function<void()> progress) {
  History::Settings settings = options.history;
  settings.stop_request = options.stop_request;
  settings.progress = std::move(progress);
  return settings;
}

/// Ends what escape_of() begins.
constexpr std::string_view kPlain = "\x1b[0m";

/// By then whatever belongs to an instant has been told.
constexpr Time kTold = kSecond;

}  // namespace

Debugger::Debugger(serial::Simulation& simulation, std::ostream& out, const DebuggerOptions& options)
    : Debugger(std::vector{&simulation}, out, options) {}

Debugger::Debugger(const std::vector<serial::Simulation*>& stations, std::ostream& out, const DebuggerOptions& options)
    : out_(out),
      options_(options),
      history_(stations, settings_of(options, [this] { show_progress(); })),
      stepper_(history_, options.stop_request) {
  stepper_.pause_when(options.pause);
  for (serial::Simulation* const station : stations) stations_.emplace_back(*station);
  for (const DebuggedStation& station : options_.stations) name_width_ = std::max(name_width_, station.name.size());
  for (const LineStation& station : history_.line_stations()) name_width_ = std::max(name_width_, station.name.size());
  stepper_.look_at(options_.station);
  stepper_.set_host_timeout(options_.master.timeout);
  stepper_.on_record = [this](std::size_t station, const TraceRecord& record) { print_trace(station, record); };
  stepper_.on_instruction = [this](std::size_t station, const InstructionRecord& record, bool started_at) {
    print_instruction(station, record, started_at);
  };
  stepper_.on_message = [this](const StopPoint& stop, const Hit& hit) { print_message(stop, hit); };
  stepper_.on_answer = [this](std::size_t station, const serial::Exchange& exchange) { print_answer(station, exchange); };
  stepper_.on_unasked = [this](const SentByPlc& sent) { print_unasked(sent); };
}

bool Debugger::open(Recording recording, const Moment& at, const std::vector<MemoryRange>& failed) {
  if (!history_.replay(std::move(recording))) return false;
  history_.go_to(at);
  failed_ = {focus(), history_.now(), failed};
  return true;
}

Debugger::Error Debugger::execute(std::string_view line) {
  undone_ = 0;
  Error error = execute_line(line);
  report_undone();
  return error;
}

/// Up to the first wrong command, to `quit` or to a stop request: what comes after that one is not done.
Debugger::Error Debugger::execute_line(std::string_view line) {
  const std::vector<std::string> commands = commands_in(line);
  repeatable_.clear();
  for (std::size_t i = 0; i < commands.size() && !quit_asked_; ++i) {
    if (Error error = execute_one(commands[i])) return error;
    if (!stop_requested()) continue;
    undone_ += commands.size() - i - 1;
    return {};
  }
  return {};
}

/// After a stop request.
void Debugger::report_undone() {
  if (undone_ != 0) out_ << fmt::format("not done any more: {}\n", counted(undone_, "command"));
}

Debugger::Error Debugger::execute_one(std::string_view text) {
  Arguments arguments = split(text, kBlanks);
  if (echoing_) out_ << kPrompt << stl::printable(joined(arguments)) << '\n';
  expectation_failed_ = false;
  std::string why;
  const Command* command = find_command(arguments.front(), why);
  if (!command) return why;
  arguments.erase(arguments.begin());
  if (command->run != &Debugger::set_break)  // its condition is about the routine of its place
    if (Error error = with_local_variables(arguments, current_op())) return error;
  command_ = std::string(command->name) + (arguments.empty() ? "" : " ") + joined(arguments);
  repeatable_ = command->repeats ? command_ : "";
  return (this->*command->run)(arguments);
}

/// Once a second; the view, which shows it too, while a run goes on.
void Debugger::show_progress() {
  if (is_typed_to_ && !typed_ && (typed_ = layout_.typed())) *options_.pause = true;
  if (live_status_ && layout_.refresh) layout_.refresh();
  if (host_time() < progress_at_ || is_in_view()) return;
  progress_at_ = host_time() + std::min(options_.patience, kSecond);
  progress_shown_ = true;
  out_.flush();
  options_.progress(fmt::format("at {}; Ctrl-C ends it", moment_text(simulation().time())));
}

/// Something else is to be printed.
void Debugger::hide_progress() {
  if (std::exchange(progress_shown_, false)) options_.progress("");
}

std::optional<ScriptError> Debugger::run_script(std::istream& in, bool is_whole) {
  std::size_t number = 0;
  echoing_ = true;
  undone_ = 0;
  std::optional<ScriptError> wrong;
  std::string line;
  while (!wrong && !quit_asked_ && !stop_requested() && std::getline(in, line)) {
    ++number;
    if (Error error = execute_line(line)) wrong = ScriptError{number, *error};
  }
  echoing_ = false;
  if (wrong || quit_asked_ || !stop_requested()) return wrong;
  while (is_whole && std::getline(in, line)) undone_ += commands_in(line).size();
  report_undone();
  return {};
}

bool Debugger::stop_requested() const { return options_.stop_request && *options_.stop_request; }

void Debugger::show_place() {
  if (is_system()) out_ << name_of(focus()) << "  ";
  std::string place = simulation().plc().powered() ? place_text(simulation().cpu(), listing()) : place_line(focus()) + "\n";
  if (const std::size_t mark = place.find("\n > "); mark != std::string::npos) place.replace(mark + 2, 1, bold(">"));
  out_ << place;
  if (is_in_view()) return;  // what is displayed too
  for (const auto& [station, range] : displayed_) out_ << said_of(station) << memory_text(station, range);
}

void Debugger::go(const Run& run) {
  const bool executes = simulation().plc().executes();
  if (!executes && !run.of_all) {
    report_standstill();
    return;
  }
  remember();
  show_ = run.show;
  first_error_.reset();
  unasked_ = 0;
  const std::uint64_t errors_before = errors_of_all();
  begin_live_status();
  let_traces_follow();
  const auto stop = at_length([&] { return run_through(run); });
  live_status_.reset();
  write_trace(kNever);
  if (!stop) return;
  look_at(stop->station);
  report(*stop, run, errors_of_all() - errors_before);
  if (typed_) carry_out_typed();  // the run has ended meanwhile
}

/// To its end, with what is typed meanwhile. Nothing after a typed command that has moved it, which has said where it
/// stands.
std::optional<Stop> Debugger::run_through(const Run& run) {
  const Time now = history_.now().time, end = now < kNever - run.limit ? now + run.limit : kNever;
  is_typed_to_ = run.of_all && options_.pause && layout_.typed && options_.history.drive;
  Stop stop = stepper_.run(run.goal, end, run.stop_at_answer);
  while (stop.reason == StopReason::Request && typed_) {
    if (!carry_out_typed()) return is_typed_to_ = false, std::nullopt;
    stop = stepper_.run(run.goal, end, run.stop_at_answer);
  }
  is_typed_to_ = false;
  if (stop.reason != StopReason::Limit || !run.to_scan_end || !simulation().plc().executes()) return stop;
  return stepper_.run(goal::scan(simulation().cpu().state(), 1), kNever, run.stop_at_answer);
}

/// What was typed while a run goes on. Returns whether the run is to go on: not after a command that has moved it.
bool Debugger::carry_out_typed() {
  const std::string line = std::exchange(typed_, {}).value();
  *options_.pause = false;
  hide_progress();
  const History::Place place = history_.here();
  const std::string command = command_, repeatable = repeatable_;
  if (const Error error = execute_line(line)) out_ << red(stl::printable(*error)) << '\n';
  out_.flush();
  command_ = command;
  repeatable_ = repeatable;
  const History::Place here = history_.here();
  return !quit_asked_ && here.branch == place.branch && here.moment.instructions == place.moment.instructions &&
         here.moment.time == place.moment.time;
}

/// There is nothing to step through, and what can be done.
void Debugger::report_standstill() {
  const State& state = simulation().cpu().state();
  const bool powered = simulation().plc().powered();
  if (is_system()) {
    out_ << fmt::format("{} {} and executes nothing; 'continue' runs the others, 'station NAME' goes over to one of them\n",
                        name_of(focus()), powered ? "is in STOP" : "is without power");
    return;
  }
  if (!powered) {
    out_ << fmt::format("{}; 'continue' lets time pass, 'rstep' and 'back' return to before that\n",
                        without_power_text(name_of(focus())));
    return;
  }
  out_ << fmt::format(
      "the CPU is in STOP and executes nothing; 'continue' lets time pass, {}, 'rstep' and 'back' return to before that\n",
      state.fatal_code == 0 ? "'mode run' starts it" : "'restart' powers it up again");
}

/// What ran before says nothing of what comes.
void Debugger::note_going_elsewhere() {
  for (Station& station : stations_) station.last_op.reset();
  traces_follow_ = false;
}

/// Before something is traced.
void Debugger::let_traces_follow() {
  if (!tracing_ || std::exchange(traces_follow_, true)) return;
  std::vector<TraceLines*> traces;
  for (Station& station : stations_) traces.push_back(&station.trace_lines);
  at_length([&] { return tell_what_was_before(history_, traces, options_.stop_request); });
}

void Debugger::remember() {
  if (kept_.size() == kKeptStates) kept_.pop_front();
  kept_.push_back({command_, history_.here(), focus()});
}

void Debugger::go_back(const Stepper::Goal& goal, std::uint64_t count, bool stop_at_answer) {
  remember();
  first_error_.reset();
  const Stop stop = at_length([&] { return stepper_.run_back(goal, count, stop_at_answer); });
  look_at(stop.station);
  note_going_elsewhere();
  report_hits(stop);
  report_reason(stop, {});
  for (const std::size_t asker : stop.answered) print_answer(asker, stations_[asker].simulation->master().exchange());
  show_place();
  note_the_past();
}

/// Says it once each time that someone goes back.
void Debugger::note_the_past() {
  if (!history_.in_the_past()) return;
  out_ << fmt::format("  in the past; going forward plays what has run, up to {}\n", moment_text(history_.newest().time));
}

void Debugger::act(Action action, std::size_t station) {
  const bool branches = history_.in_the_past();
  const Time left = history_.newest().time;
  if (branches) remember();
  let_traces_follow();
  Told told([&](const TraceRecord& record) { print_trace(history_.told_of(), record); });
  history_.act(std::move(action), station, &told);
  write_trace(kNever);
  if (!branches) return;
  out_ << fmt::format("a new branch begins here; what ran up to {} is on the old one, to which 'back' returns\n",
                      moment_text(left));
  note_new_branch();
}

/// A record of what went on cannot go back: a capture ends, a trace says so by its times.
void Debugger::note_new_branch() {
  for (const Station& station : stations_) station.simulation->plc().unwatch_lines();
  stepper_.count_hits();
  if (options_.files.empty()) return;
  out_ << fmt::format("{}: traces go on with what is new, after what ran before; captures of the line end\n",
                      options_.files);
  options_.files.clear();
}

void Debugger::report(const Stop& stop, const Run& run, std::uint64_t errors) {
  if (first_error_) {
    const auto& [station, error] = *first_error_;
    out_ << said_of(station) << red(describe(error, stations_[station].simulation->cpu().program()));
    out_ << (errors > 1 ? fmt::format(" and {} more; 'errors' lists them\n", errors - 1) : "\n");
    if (station == focus() && error.op != kNoRoutine) print_bad_pointers(error.op);
  }
  report_hits(stop);
  report_reason(stop, run);
  show_place();
}

void Debugger::report_reason(const Stop& stop, const Run& run) {
  switch (stop.reason) {
    case StopReason::Goal:
    case StopReason::StopPoint:
    case StopReason::Answer:
      return;
    case StopReason::Limit:
      out_ << fmt::format("{} of simulated time passed with nothing to stop for{}{}\n", format_duration(run.limit),
                          run.limit == kDefaultLimit ? " (the limit; 'continue TIME' sets another)" : "",
                          within_scan_text(run));
      return;
    case StopReason::Request: {
      const std::string failure = options_.take_failure();
      out_ << (failure.empty() ? interruption_text() : failure) << '\n';
      return;
    }
    case StopReason::CpuStopped:
      report_cpu_stop();
      return;
    case StopReason::Oldest:
      out_ << at_oldest_text(history_) << '\n';
      report_uncounted();
      return;
  }
}

/// Outputs and what the program has computed are those of a scan that is not over.
std::string Debugger::within_scan_text(const Run& run) const {
  const State& state = simulation().cpu().state();
  const bool is_within = run.of_all && simulation().plc().executes() && standing_at(state).value_or(0) != 0;
  if (!is_within) return {};
  return fmt::format("; it stands within a scan, to whose end 'continue {} scan' would go", format_duration(run.limit));
}

void Debugger::report_cpu_stop() {
  const State& state = simulation().cpu().state();
  const auto last_op = stations_[focus()].last_op;
  if (state.fatal_code != 0) {
    const std::string place = state.fatal_op == kNoRoutine ? "between two scans" : "in " + op_text(state.fatal_op);
    out_ << said_of(focus())
         << red(fmt::format("the CPU went to STOP: fatal error {:04X}, {},", state.fatal_code,
                            meaning_of(FatalError{state.fatal_code})))
         << "\n  " << place << '\n';
  } else if (last_op) {
    out_ << fmt::format("{}the CPU went to STOP; the last instruction was in {}\n", said_of(focus()), op_text(*last_op));
  }
}

std::string Debugger::op_text(const Listing& listing, std::uint32_t op) {
  return fmt::format("{} line {}: {}", listing.routine_of(op), listing.line_of(op), listing.text_of(op));
}

void Debugger::print_answer(std::size_t station, const serial::Exchange& exchange) {
  hide_progress();
  out_ << exchange_text(exchange, master(station).timeout) << not_an_answer_text(history_, station, exchange);
  const serial::Plc& plc = stations_[station].simulation->plc();
  if (exchange.timed_out && plc.powered() && !plc.executes())
    out_ << "         the CPU is in STOP, where no program answers\n";
}

/// The first few of a run.
void Debugger::print_unasked(const SentByPlc& sent) {
  constexpr std::size_t kShown = 3;
  if (++unasked_ > kShown) return;
  hide_progress();
  const serial::Exchange& last = simulation().master().exchange();
  out_ << unasked_text(sent.bytes)
       << fmt::format("         from {} to {}{}\n", moment_text(sent.from), moment_text(sent.to),
                      last.timed_out || last.given_up ? ", after the master had given up" : "");
  if (unasked_ == kShown) out_ << "         no more of this run are shown; 'break sent' stops at each\n";
}

void Debugger::print_trace(std::size_t station, const TraceRecord& record) {
  if (record.kind == TraceKind::RuntimeError && !first_error_) first_error_ = {station, record};
  if (!tracing_) return;
  const std::vector<TraceLine> of_record = stations_[station].trace_lines.of(record);
  if (record.kind != TraceKind::ScanBegin && is_shown(record)) print_trace_lines(station, of_record);
}

/// CPUs of a system end their instructions at different times, and the way of a program is told at its end: lines wait until
/// no other one can come before them.
void Debugger::print_trace_lines(std::size_t station, const std::vector<TraceLine>& lines) {
  if (!is_system()) {
    if (!lines.empty()) hide_progress();
    for (const TraceLine& line : lines) write_trace_line(line);
    return;
  }
  for (const TraceLine& line : lines)
    trace_waiting_.push_back({line.at, fmt::format("{:<{}}  {}", name_of(station), name_width_, line.text), line.trouble});
  constexpr std::size_t kMostWaiting = 10'000;
  if (trace_waiting_.size() >= kMostWaiting) write_trace(history_.now().time - std::min(history_.now().time, kTold));
}

void Debugger::write_trace_line(const TraceLine& line) {
  const std::string text = fmt::format("  {}  {}", clock_text(line.at), line.text);
  out_ << (line.trouble ? painted(text, Paint::Yellow) : text) << '\n';
}

void Debugger::write_trace(Time until) {
  std::ranges::stable_sort(trace_waiting_, {}, &TraceLine::at);
  if (!trace_waiting_.empty()) hide_progress();
  const auto rest = std::ranges::lower_bound(trace_waiting_, until, {}, &TraceLine::at);
  for (auto line = trace_waiting_.begin(); line != rest; ++line) write_trace_line(*line);
  trace_waiting_.erase(trace_waiting_.begin(), rest);
}

void Debugger::print_instruction(std::size_t station, const InstructionRecord& record, bool started_at) {
  const bool looked_at = station == focus();
  Station& of = stations_[station];
  of.last_op = record.op;
  if (looked_at && live_status_) note_live_status(record);
  if (const auto line = tracing_ ? of.trace_lines.of(record) : std::nullopt) print_trace_lines(station, {*line});
  if (!looked_at || show_ == Show::None || (show_ == Show::Started && !started_at)) return;
  hide_progress();
  const Cpu& cpu = of.simulation->cpu();
  out_ << fmt::format("   {}  {}\n", describe(execution_of(record, cpu), cpu.program()),
                      format_duration(record.end - record.at));
}

std::string_view Debugger::escape_of(Paint paint) {
  switch (paint) {
    case Paint::Red:
      return "\x1b[31m";
    case Paint::Yellow:
      return "\x1b[33m";
    case Paint::Bold:
      return "\x1b[1m";
  }
  return {};
}

std::string Debugger::painted(std::string text, Paint paint) const {
  if (text.empty() || !options_.colour) return text;
  return fmt::format("{}{}{}", escape_of(paint), text, kPlain);
}

std::string Debugger::memory_text(std::size_t station, const MemoryRange& range) const {
  const Cpu& cpu = stations_[station].simulation->cpu();
  const std::string forced = forced_text(cpu, {bits_of(range)});
  const std::string symbol = symbol_text(cpu.program(), range);
  return dump_text(cpu, range) + (forced.empty() ? "" : "       " + forced + "\n") +
         (symbol.empty() ? "" : "         " + symbol + "\n");
}

std::optional<std::uint32_t> Debugger::current_op() const {
  const State& state = simulation().cpu().state();
  if (state.mode == Mode::Run) return standing_at(state).value_or(0);
  return state.fatal_code != 0 && state.fatal_op != kNoRoutine ? std::optional(state.fatal_op) : stations_[focus()].last_op;
}

}  // namespace s7200::tools
