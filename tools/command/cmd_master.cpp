#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <utility>

#include "interpreter/base/text.hpp"
#include "serial_sim/modbus/line_turns.hpp"
#include "tools/command/commands.hpp"
#include "tools/master/statistics.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/options/fault_options.hpp"
#include "tools/slave/host_link.hpp"
#include "tools/host/interruption.hpp"
#include "tools/master/action.hpp"
#include "tools/command/options/master_options.hpp"
#include "tools/master/report.hpp"
#include "tools/command/options/number_option.hpp"
#include "tools/command/options/plant_options.hpp"
#include "tools/command/options/program_options.hpp"
#include "tools/views/report.hpp"
#include "tools/views/results_json.hpp"
#include "tools/slave/simulated_slave.hpp"
#include "tools/slave/slave_target.hpp"
#include "tools/host/terminal.hpp"

namespace s7200::tools {
namespace {

using modbus::Verdict;
using Kind = SlaveTarget::Kind;

struct MasterVerb {
  std::string target;
  std::vector<std::string> words;
  ActionRules rules;
  int station = 1;
  std::string form = std::string(value_forms().front().name);
  bool verbose = false, json = false, continuous = false;
  Time every = kNever;      // kNever: no polling
  std::uint64_t count = 0;  // rounds; 0: one, or until Ctrl-C
  int retries = 0;
  Time pause = kNever;    // kNever: Slave::pause
  Time after = kNever;    // kNever: when the program is ready
  Time silence = kNever;  // kNever: as the slave has it
  MasterOptions master;
  ProgramOptions program;
  PlantOptions plant;
  std::vector<CLI::Option*> for_programs, for_lines, for_rtu;  // that other targets have no use for

  bool polls() const { return every != kNever; }
  bool open_ended() const { return count == 0 && (polls() || continuous); }
  std::uint64_t rounds() const { return open_ended() ? UINT64_MAX : std::max<std::uint64_t>(count, 1); }
};

constexpr std::uint16_t kFirstLoopback = 0x1234;
constexpr int kFailuresShown = 10;
constexpr const char* kEraseLine = "\r\x1b[K";  // ECMA-48

void refuse_options(const std::vector<CLI::Option*>& options, const char* need) {
  for (const CLI::Option* option : options)
    if (option->count() > 0) throw std::invalid_argument(fmt::format("{} needs {}", option->get_name(), need));
}

/// In simulation nothing but the reader slows down what would be written for ever.
void refuse_a_flood(const MasterVerb& verb) {
  const bool writes_each = verb.polls() || verb.json || verb.verbose;
  if (!verb.open_ended() || !writes_each || isatty(STDOUT_FILENO)) return;
  throw std::invalid_argument(
      fmt::format("{} without --count never ends, and a simulation writes as fast as it can: say how often with --count N",
                  verb.polls() ? "--every" : "--continuous"));
}

void refuse_what_does_not_fit(const MasterVerb& verb, Kind kind) {
  if (kind == Kind::Program) refuse_a_flood(verb);
  if (kind != Kind::Program) refuse_options(verb.for_programs, "a PROGRAM to run in simulation");
  if (kind == Kind::Tcp || kind == Kind::ModbusTcp)
    refuse_options(verb.for_lines, "a serial line; the target is a connection over TCP");
  if (kind == Kind::ModbusTcp) refuse_options(verb.for_rtu, "Modbus RTU; Modbus TCP sends whole frames");
}

/// Does the actions, round after round, and tells what comes of them.
class MasterSession {
 public:
  MasterSession(const MasterVerb& verb, Slave& slave, const std::vector<MasterAction>& actions, bool broadcasts_are_silent)
      : verb_(verb),
        slave_(slave),
        actions_(actions),
        broadcasts_are_silent_(broadcasts_are_silent),
        table_(title(), verb.rules.format, can_redraw(stdout), colour_wanted(stdout)) {}

  /// Throws SlaveUnreachable.
  void run();

  /// From now on, whether to end before all is done, as after Ctrl-C.
  void end_early_if(std::function<bool()> reason) { reason_to_end_ = std::move(reason); }

  const ExchangeStatistics& statistics() const { return statistics_; }

  /// As they were written.
  std::vector<std::string> raw_frames() const;

  /// Say what belongs before the first result and behind the last, where the JSON of results stands between them.
  void begin() const;
  void end(const std::string& error, const nlohmann::ordered_json& plant);

 private:
  std::string title() const;
  bool over() const { return interrupted() || (reason_to_end_ && reason_to_end_()); }
  void run_round();
  /// Nothing after Ctrl-C.
  std::optional<MasterResult> perform(const MasterAction& action);
  serial::Request request_of(const MasterAction& action);
  void show(const MasterResult& result);
  void show_failure(const MasterResult& result);
  void show_progress();
  void clear_progress();

  const MasterVerb& verb_;
  Slave& slave_;
  const std::vector<MasterAction>& actions_;
  const bool broadcasts_are_silent_;
  std::function<bool()> reason_to_end_;
  PollingTable table_;
  ExchangeStatistics statistics_;
  std::uint16_t loopback_ = kFirstLoopback;
  int failures_shown_ = 0;
  Time progress_at_ = 0;  // of the host; 0 when no progress is on the terminal
  bool first_ = true;
};

std::string MasterSession::title() const {
  return fmt::format("{}, every {}; Ctrl-C ends", stl::printable(slave_.name()),
                     verb_.polls() ? format_duration(verb_.every) : "round");
}

std::vector<std::string> MasterSession::raw_frames() const {
  constexpr std::string_view kWord = "raw ";
  std::vector<std::string> frames;
  for (const MasterAction& action : actions_)
    if (action.kind == MasterAction::Kind::Raw) frames.push_back(action.text.substr(kWord.size()));
  return frames;
}

serial::Request MasterSession::request_of(const MasterAction& action) {
  modbus::Frame frame = action.frame;
  if (action.kind == MasterAction::Kind::Loopback)
    frame = modbus::to_frame(modbus::rtu_frame(action.station, modbus::diagnostics(0, std::array{loopback_++})));
  else if (action.kind == MasterAction::Kind::Request)
    frame = modbus::to_frame(modbus::rtu_frame(action.station, action.pdu));
  serial::Request request = verb_.master.request(frame);
  if (!action.answer_expected) request.timeout = std::min(request.timeout, modbus::LineTurns::kTurnaround);
  if (verb_.silence != kNever) request.silence = verb_.silence;
  return request;
}

std::optional<MasterResult> MasterSession::perform(const MasterAction& action) {
  const serial::Request request = request_of(action);
  MasterResult result{.action = &action};
  for (;; ++result.attempts) {
    const bool last = result.attempts > verb_.retries;
    try {
      result.exchange = slave_.exchange(request);
      if (interrupted()) return {};
      result.remark = slave_.remark();
      result.answer = assess(action, result.exchange, broadcasts_are_silent_);
      slave_.wait(verb_.pause == kNever ? slave_.pause() : verb_.pause);
      if (last || result.answer.verdict == Verdict::Right || result.answer.verdict == Verdict::Exception) break;
    } catch (const SlaveUnreachable&) {
      if (last || interrupted()) throw;
      slave_.wait(verb_.master.timeout);
    }
    statistics_.add_retry();
  }
  statistics_.add(result.answer.verdict, result.exchange.latency());
  return result;
}

void MasterSession::show_failure(const MasterResult& result) {
  if (result.answer.verdict == Verdict::Right || failures_shown_ > kFailuresShown) return;
  clear_progress();
  if (failures_shown_++ == kFailuresShown)
    fmt::print("further failures are only counted\n");
  else
    fmt::print("{}: {}\n", heading(result), short_text(result, verb_.rules.format));
}

void MasterSession::show(const MasterResult& result) {
  if (verb_.json) {
    fmt::print("{}    {}", first_ ? "" : ",\n", line_of(to_json(result, verb_.rules.format)));
    first_ = false;
  } else if (verb_.polls() && !verb_.verbose) {
    table_.add(result, result.exchange.request_start);
  } else if (verb_.continuous && !verb_.verbose) {
    show_failure(result);
  } else {
    fmt::print("{}\n", heading(result));
    if (verb_.verbose) fmt::print("{}", frames_text(result));
    for (const std::string& line : lines(result, verb_.rules.format)) fmt::print("{}\n", line);
  }
}

/// On a terminal, twice a second, in a line that the next output overwrites.
void MasterSession::show_progress() {
  constexpr Time kInterval = kSecond / 2;
  if (!can_redraw(stderr) || host_time() - progress_at_ < kInterval) return;
  progress_at_ = host_time();
  const std::string text = statistics_.text();
  fmt::print(stderr, "{}{}\r", kEraseLine, text.substr(0, text.find('\n')));
}

void MasterSession::clear_progress() {
  if (std::exchange(progress_at_, 0) != 0) fmt::print(stderr, "{}", kEraseLine);
}

void MasterSession::run_round() {
  for (const MasterAction& action : actions_) {
    if (over()) return;
    if (action.kind == MasterAction::Kind::Station) continue;
    if (action.kind == MasterAction::Kind::Wait) {
      slave_.wait(action.duration);
      continue;
    }
    if (const auto result = perform(action)) show(*result);
  }
}

void MasterSession::run() {
  const std::uint64_t rounds = verb_.rounds();
  Time next = slave_.now();
  for (std::uint64_t round = 0; round < rounds && !over(); ++round) {
    run_round();
    if (verb_.continuous) show_progress();
    if (!verb_.polls()) continue;
    if (!verb_.json) table_.end_round(can_redraw(stdout) ? statistics_.text() : "");
    // A round that took longer than its time is followed by the next at once; those missed are not made up for.
    next = std::max(next + verb_.every, slave_.now());
    if (round + 1 < rounds) slave_.wait(next - slave_.now());
  }
}

void MasterSession::begin() const {
  if (!verb_.json) return;
  auto head = results_of("master");
  head["target"] = slave_.name();
  fmt::print("{{\n");
  for (const auto& [key, value] : head.items()) fmt::print("  \"{}\": {},\n", key, line_of(value));
  fmt::print("  \"exchanges\": [\n");
}

void MasterSession::end(const std::string& error, const nlohmann::ordered_json& plant) {
  clear_progress();
  if (verb_.json) {
    fmt::print("{}  ],\n  \"statistics\": {},\n", first_ ? "" : "\n", statistics_.json().dump());
    for (const auto& [key, value] : plant.items()) fmt::print("  \"{}\": {},\n", key, line_of(value));
    fmt::print("  \"error\": {}\n}}\n", error.empty() ? "null" : line_of(error));
  } else if (verb_.polls() && can_redraw(stdout)) {
    table_.finish();
  } else if (verb_.rounds() > 1) {
    fmt::print("{}", statistics_.text());
  }
}

/// From the first exchange to what is said at the end, whichever way it ends. `plant` then
/// says what the JSON has of the plant around the CPU.
template <typename Plant>
int run_session(const MasterVerb& verb, MasterSession& session, Plant plant) {
  std::string error;
  session.begin();
  try {
    session.run();
  } catch (const std::exception& end) {  // SlaveUnreachable, or a frame that cannot be sent to this slave
    error = end.what();
  }
  session.end(error, plant());
  if (!error.empty()) {
    print_error(error);
    return kUnusable;
  }
  if (!session.statistics().latency()) fmt::print(stderr, "{}", torn_frame_note(session.raw_frames()));
  const bool cut_short = interrupted() && !verb.open_ended();
  if (cut_short) print_interruption();
  return session.statistics().any_failed() || cut_short ? kCheckFailed : kFine;
}

int run_on_program(MasterVerb& verb, const std::vector<MasterAction>& actions) {
  int exit_code = kFine;
  verb.program.path = verb.target;
  const auto program = verb.program.load(exit_code);
  if (!program) return exit_code;
  if (!verb.plant.prepare(program, verb.json)) return kUnusable;
  serial::Simulation simulation(program, verb.plant.field());
  verb.plant.power_up(simulation);
  SimulatedSlave slave(simulation, verb.master, program->source.name);
  MasterSession session(verb, slave, actions, true);
  session.end_early_if([&] { return verb.plant.failed_strictly(simulation.cpu()); });
  if (!slave.wait_until_ready(verb.after)) {
    if (verb.json) {
      session.begin();
      session.end("the program was not ready for the first request", verb.plant.json(simulation));
    }
    fmt::print(stderr, "{}", errors_text(simulation.cpu()));
    if (!simulation.cpu().state().fatal_code && simulation.cpu().state().mode == Mode::Stop)
      print_error("the CPU went to STOP before the first request");
    print_interruption();
    if (!verb.plant.finish(simulation)) return kUnusable;
    return simulation.cpu().state().fatal_code ? kCpuFatal : kCheckFailed;
  }

  exit_code = run_session(verb, session, [&] { return verb.plant.json(simulation); });
  const bool all_written = verb.plant.finish(simulation);
  if (!verb.json) fmt::print("{}", verb.plant.dump_text(simulation.cpu()));
  fmt::print(stderr, "{}{}", errors_text(simulation.cpu()), faults_text(simulation.faults()));
  if (simulation.cpu().state().mode == Mode::Stop) fmt::print(stderr, "s7200: note: the CPU is in STOP\n");
  if (!all_written) return kUnusable;
  if (simulation.cpu().state().fatal_code) return kCpuFatal;
  if (!verb.plant.failed_strictly(simulation.cpu())) return exit_code;
  print_error("--strict: a run-time error ended the session");
  return kCheckFailed;
}

int run_master(MasterVerb& verb) {
  const SlaveTarget target = parse_slave_target(verb.target);
  refuse_what_does_not_fit(verb, target.kind);
  const bool over_tcp = target.kind == Kind::ModbusTcp;
  for (const ValueFormName& form : value_forms())
    if (form.name == verb.form) verb.rules.format.form = form.form;
  // 255 is a Modbus TCP server itself, not a station behind it (Modbus Messaging on TCP/IP, 4.4.2).
  verb.rules.last_station = verb.rules.beyond_limits || over_tcp ? UINT8_MAX : modbus::kLastStation;
  verb.rules.station =
      static_cast<std::uint8_t>(parse_number(std::to_string(verb.station), 0, verb.rules.last_station, "--station"));
  const std::vector<MasterAction> actions = parse_actions(verb.words, verb.rules);

  catch_interruption();
  if (target.kind == Kind::Program) return run_on_program(verb, actions);
  std::unique_ptr<Slave> slave;
  try {
    slave = connect(target, verb.master.format_over({}));
  } catch (const SlaveUnreachable& error) {
    print_error(error.what());
    return kUnusable;
  }
  MasterSession session(verb, *slave, actions, !over_tcp);
  return run_session(verb, session, PlantOptions::no_json);
}

/// The options that `add` adds.
template <typename Add>
std::vector<CLI::Option*> added_by(CLI::App& app, Add add) {
  const auto before = app.get_options();
  add();
  std::vector<CLI::Option*> added = app.get_options();
  std::erase_if(added, [&](const CLI::Option* option) { return std::ranges::find(before, option) != before.end(); });
  return added;
}

std::string form_names() {
  std::string text;
  for (const ValueFormName& form : value_forms()) text.append(text.empty() ? "" : ", ").append(form.name);
  return text;
}

}  // namespace

void add_master(CLI::App& app, int& exit_code) {
  auto verb = std::make_shared<MasterVerb>();
  CLI::App* sub =
      app.add_subcommand("master", "be a Modbus master: ask a program, a serial device, or a server on the network");
  sub->add_option("TARGET", verb->target, "a PROGRAM to run in simulation, a device, or an address; see below")->required();
  sub->add_option("ACTION", verb->words, "what to do, see below");
  add_whole_number(*sub, "--station", verb->station, {0, UINT8_MAX},
                   "station to ask; 0 is all of them, which do not answer; above 247 only over Modbus TCP", "1");
  sub->add_option("--as", verb->form, "how registers are shown: " + form_names())
      ->check([](const std::string& name) {
        return std::ranges::any_of(value_forms(), [&](const ValueFormName& form) { return form.name == name; })
                   ? std::string()
                   : fmt::format("'{}' is no form; there are {}", name, form_names());
      })
      ->capture_default_str()
      ->type_name("FORM");
  sub->add_flag("--low-word-first", verb->rules.format.low_word_first,
                "in values of 32 bits the first register is the low one");
  sub->add_flag("--always-15", verb->rules.always_15, "write single coils with function 15 too");
  sub->add_flag("--always-16", verb->rules.always_16, "write single registers with function 16 too");
  sub->add_flag("--crc", verb->rules.crc, "append the CRC to raw frames");
  sub->add_flag("--beyond-limits", verb->rules.beyond_limits, "send what the specification forbids, to test a slave");
  auto* every = add_duration(*sub, "--every", verb->every, "repeat all actions at this interval, in a table",
                             {kMicrosecond, kLongestDuration});
  sub->add_flag("--continuous", verb->continuous,
                "repeat all actions without a pause; only failures and statistics are shown")
      ->excludes(every);
  add_whole_number(*sub, "--count", verb->count, {1, UINT64_MAX}, "how often to repeat", "until Ctrl-C");
  add_whole_number(*sub, "--retries", verb->retries, {0, 1'000'000},
                   "ask again so often after silence, a wrong answer, or a lost connection", "0");
  add_duration(*sub, "--pause", verb->pause,
               "pause between an answer and the next request [in simulation 7 characters + 10 ms]");
  sub->add_flag("-v,--verbose", verb->verbose,
                "show requests and answers in hex, over Modbus TCP too as they are on a serial line");
  sub->add_flag("--json", verb->json, "print all exchanges and the statistics as JSON");

  const auto line = added_by(*sub, [&] { verb->master.add_to(*sub); });
  for (CLI::Option* option : line) {
    const std::string name = option->get_name();
    if (name == "--gap") verb->for_rtu.push_back(option);
    if (name != "--gap" && name != "--timeout") verb->for_lines.push_back(option);
  }
  verb->for_rtu.push_back(
      add_duration(*sub, "--silence", verb->silence,
                   "silence that ends an answer [3.5 characters; outside simulation 20ms if that is more]"));
  verb->for_programs = added_by(*sub, [&] {
    verb->program.CpuOptions::add_to(*sub);
    verb->plant.add_to(*sub);
    add_duration(*sub, "--after", verb->after,
                 "when to send the first request [after the first scan and 7 characters + 10 ms of silence]");
  });
  sub->footer(slave_targets_help() + actions_help() + fault_help() +
              "Example: s7200 master stl_programs/modbus_slave.stl write 40011=1234,-5 read 40011:2 read 00001:8");
  sub->callback([verb, &exit_code] {
    try {
      exit_code = run_master(*verb);
    } catch (const std::invalid_argument& error) {
      print_error(error.what());
      exit_code = kUnusable;
    }
  });
}

}  // namespace s7200::tools
