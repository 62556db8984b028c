#include "tools/faces/dap/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "interpreter/base/joined.hpp"
#include "interpreter/base/numbers.hpp"
#include "interpreter/base/text.hpp"
#include "interpreter/trace/text_trace.hpp"
#include "serial_sim/modbus/request.hpp"
#include "tools/faces/dap/exception_filters.hpp"
#include "tools/session/stops/goals.hpp"
#include "tools/session/stops/stop_words.hpp"
#include "tools/session/words/frame_words.hpp"
#include "tools/session/words/line_words.hpp"
#include "tools/views/machine_text.hpp"
#include "tools/views/report.hpp"
#include "tools/views/text_frame.hpp"

namespace s7200::tools::dap {
namespace {

constexpr Time kSendAfter = kSecond;  // every program has set its port up by then

constexpr std::string_view kCancelled = "cancelled";  // as the protocol says it

/// VS Code pops up what the user is to see. What it asks while he types, points or steps has its own place for a refusal,
/// and it is VS Code that cancels.
bool pops_up(std::string_view command, std::string_view message) {
  return command != "evaluate" && command != "stlStatus" && message != kCancelled;
}

Json capabilities() {
  Json filters = Json::array();
  for (const ExceptionFilter& filter : kExceptionFilters)
    filters.push_back({{"filter", filter.id},
                       {"label", filter.label},
                       {"description", filter.description},
                       {"default", filter.id == "watchdog"},
                       {"supportsCondition", !filter.codes.empty()},
                       {"conditionDescription", filter.codes}});
  Json body{{"exceptionBreakpointFilters", filters}, {"completionTriggerCharacters", Json::array({"*", "B", "W", "D"})}};
  for (const char* offered : {"supportsConfigurationDoneRequest",
                              "supportsFunctionBreakpoints",
                              "supportsConditionalBreakpoints",
                              "supportsHitConditionalBreakpoints",
                              "supportsEvaluateForHovers",
                              "supportsStepBack",
                              "supportsSetVariable",
                              "supportsGotoTargetsRequest",
                              "supportsCompletionsRequest",
                              "supportsRestartRequest",
                              "supportsValueFormattingOptions",
                              "supportsExceptionInfoRequest",
                              "supportsDelayedStackTraceLoading",
                              "supportsLoadedSourcesRequest",
                              "supportsLogPoints",
                              "supportsSetExpression",
                              "supportsTerminateRequest",
                              "supportsDataBreakpoints",
                              "supportsDataBreakpointBytes",
                              "supportsReadMemoryRequest",
                              "supportsWriteMemoryRequest",
                              "supportsDisassembleRequest",
                              "supportsCancelRequest",
                              "supportsBreakpointLocationsRequest",
                              "supportsClipboardContext",
                              "supportsSteppingGranularity",
                              "supportsInstructionBreakpoints",
                              "supportsExceptionFilterOptions"})
    body[offered] = true;
  return body;
}

}  // namespace

Session::Session(SessionSettings settings, Send send) : settings_(std::move(settings)), send_(std::move(send)) {}

Session::~Session() = default;

const std::vector<Session::Request>& Session::requests() {
  static const std::vector<Request> kTable =
      with_commands({{"initialize", &Session::initialize, Needs::Nothing},
                     {"launch", &Session::launch, Needs::Nothing},
                     {"attach", &Session::attach, Needs::Nothing},
                     {"configurationDone", &Session::configuration_done},
                     {"restart", &Session::restart},
                     {"terminate", &Session::terminate},
                     {"disconnect", &Session::disconnect, Needs::Nothing},
                     {"cancel", &Session::cancel, Needs::Nothing},
                     {"setBreakpoints", &Session::set_breakpoints},
                     {"setFunctionBreakpoints", &Session::set_function_breakpoints},
                     {"setDataBreakpoints", &Session::set_data_breakpoints},
                     {"setInstructionBreakpoints", &Session::set_instruction_breakpoints},
                     {"setExceptionBreakpoints", &Session::set_exception_breakpoints},
                     {"breakpointLocations", &Session::breakpoint_locations},
                     {"dataBreakpointInfo", &Session::data_breakpoint_info},
                     {"exceptionInfo", &Session::exception_info},
                     {"continue", &Session::go_on, Needs::Standstill},
                     {"next", &Session::next, Needs::Standstill},
                     {"stepIn", &Session::step_in, Needs::Standstill},
                     {"stepOut", &Session::step_out, Needs::Standstill},
                     {"stepScan", &Session::step_scan, Needs::Standstill},
                     {"stepInterrupt", &Session::step_interrupt, Needs::Standstill},
                     {"pause", &Session::pause},
                     {"stepBack", &Session::step_back, Needs::Standstill},
                     {"reverseContinue", &Session::reverse_continue, Needs::Standstill},
                     {"reverseStepOver", &Session::reverse_step_over, Needs::Standstill},
                     {"reverseStepOut", &Session::reverse_step_out, Needs::Standstill},
                     {"reverseStepScan", &Session::reverse_step_scan, Needs::Standstill},
                     {"reverseStepInterrupt", &Session::reverse_step_interrupt, Needs::Standstill},
                     {"gotoTargets", &Session::goto_targets},
                     {"goto", &Session::go_to, Needs::Standstill},
                     {"goToMoment", &Session::go_to_moment, Needs::Standstill},
                     {"threads", &Session::threads, Needs::Nothing},
                     {"stackTrace", &Session::stack_trace},
                     {"scopes", &Session::scopes},
                     {"variables", &Session::variables},
                     {"loadedSources", &Session::loaded_sources},
                     {"source", &Session::source, Needs::Nothing},
                     {"evaluate", &Session::evaluate},
                     {"completions", &Session::completions},
                     {"disassemble", &Session::disassemble},
                     {"readMemory", &Session::read_memory},
                     {"writeMemory", &Session::write_memory},
                     {"setVariable", &Session::set_variable},
                     {"setExpression", &Session::set_expression},
                     {"timeline", &Session::timeline},
                     {"stlStatus", &Session::stl_status}});
  return kTable;
}

// --- messages ---

void Session::handle(const Json& message) {
  const std::string type = text_in(message, "type");
  if (type == "response" || type == "event") return;  // to nothing we have asked
  if (type != "request") return complain(fmt::format("'{}' has no type 'request'", stl::shortened(message.dump())));
  const std::string command = text_in(message, "command");
  const auto found = std::ranges::find(requests(), command, &Request::command);
  handling_ = number_in(message, "seq");
  later_.clear();
  try {
    if (found == requests().end())
      throw Refused(fmt::format("'{}' is not a request that is offered", stl::shortened(command)));
    respond(message, true, dispatch(*found, map_at(message, "arguments")));
  } catch (const Refused& refused) {
    respond(message, false, {}, refused.what());
  } catch (const WrongValue& wrong) {
    respond(message, false, {}, wrong.what());
  }
  for (const auto& action : std::exchange(later_, {})) action();
}

Json Session::dispatch(const Request& request, const Json& arguments) {
  const auto handled = [&](const Json& of) {
    return request.handler ? (this->*request.handler)(of) : run_command(std::string(request.command), of);
  };
  const bool needs_program = request.needs != Needs::Nothing, needs_standstill = request.needs == Needs::Standstill;
  if (needs_program && !debuggee_) throw Refused("there is no program yet: launch or attach comes first");
  if (needs_program && terminated_) throw Refused("the session has ended");
  if (needs_standstill && runs()) throw Refused("the program runs: pause it first");
  if (!debuggee_) return handled(arguments);
  Json of_station = arguments;
  const auto station = take_station(of_station);
  Json body;
  {
    const LookAt look(*this, station.value_or(looks_at()));
    body = handled(of_station);
  }
  if (station && needs_standstill) session_->stepper.look_at(*station);  // there it runs, unless it was refused
  return body;
}

/// The station that a request names, which does not stand in its references then; nothing if it names none.
std::optional<std::size_t> Session::take_station(Json& arguments) const {
  std::optional<std::int64_t> station;
  const auto take_number = [&](const char* key, std::int64_t of_a_station, std::string_view what) {
    if (!member(arguments, key)) return;
    const auto number = number_at<std::int64_t>(arguments, key);
    station = number / of_a_station;
    if (number < 0 || *station >= static_cast<std::int64_t>(stations()))
      throw Refused(fmt::format("there is no {} {}", what, number));
    arguments[key] = number % of_a_station;
  };
  if (member(arguments, "threadId")) station = std::int64_t{number_at<std::int32_t>(arguments, "threadId")} - 1;
  take_number("frameId", kFramesOfAStation, "frame");
  take_number("variablesReference", kContainersOfAStation, "variablesReference");
  for (const char* const key : {"memoryReference", "name"}) {
    if (!member(arguments, key) || (key == std::string_view("name") && !truth_at(arguments, "asAddress", false))) continue;
    const std::string text = text_at(arguments, key);
    const auto found = find_station(text, stations());
    if (!found) throw Refused(fmt::format("'{}' is of no station of this system", stl::shortened(text)));
    station = static_cast<std::int64_t>(found->station);
    arguments[key] = found->reference;
  }
  if (!station) return {};
  if (*station < 0 || static_cast<std::size_t>(*station) >= stations())
    throw Refused(fmt::format("there is no thread {}", *station + 1));
  return static_cast<std::size_t>(*station);
}

void Session::refuse(const Json& message, const std::string& why) { respond(message, false, {}, why); }

void Session::complain(const std::string& wrong) { print("skipped what is not a message: " + wrong, "stderr"); }

void Session::respond(const Json& request, bool success, Json body, const std::string& message) {
  Json response{{"seq", ++sent_},
                {"type", "response"},
                {"request_seq", number_in(request, "seq")},
                {"success", success},
                {"command", text_in(request, "command")}};
  if (!success) {
    response["message"] = message;
    body = {{"error", {{"id", 1}, {"format", message}, {"showUser", pops_up(text_in(request, "command"), message)}}}};
  }
  if (!body.is_null()) response["body"] = std::move(body);
  send_(response);
}

void Session::send_event(const std::string& event, Json body) {
  Json message{{"seq", ++sent_}, {"type", "event"}, {"event", event}};
  if (!body.is_null()) message["body"] = std::move(body);
  send_(message);
}

std::string Session::said_of(std::size_t station) const { return session_->said_of(station); }

/// The first one that has the file in its program; the one looked at if it has it too, or none has.
std::size_t Session::station_with(const std::string& path) const {
  const auto has = [&](std::size_t station) { return sources_[station].line_in(path, 1).has_value(); };
  for (std::size_t station = 0; station < stations() && !has(looks_at()); ++station)
    if (has(station)) return station;
  return looks_at();
}

void Session::print_of(std::size_t station, const std::string& text, const std::string& category,
                       std::optional<std::uint32_t> op) {
  const LookAt look(*this, station);
  print(said_of(station) + text, category, op);
}

void Session::print(const std::string& text, const std::string& category, std::optional<std::uint32_t> op) {
  if (text.empty()) return;
  Json body{{"category", category}, {"output", text.ends_with('\n') ? text : text + "\n"}};
  if (op) body.update(client_place(*op));
  send_event("output", std::move(body));
}

void Session::refuse_interrupted() const { throw Refused(std::string(kCancelled)); }

Json Session::client_place(std::uint32_t op) const {
  const stl::Position& position = cpu().program().statement(op).position;
  Json place = sources().place_of(position.line);
  place["line"] = client_line(place["line"].get<std::uint32_t>());
  place["column"] = std::max(position.column, 1u) - 1 + column_base_;
  return place;
}

/// The full name of the file that a request is about.
std::string Session::source_path(const Json& arguments) const {
  return full_name(text_at(required_map(arguments, "source"), "path", ""), folder_);
}

/// As the client counts lines.
std::uint32_t Session::client_line_in(const Json& arguments, const char* key) const {
  const auto line = number_at<std::int64_t>(arguments, key);
  if (line < std::int64_t{line_base_} || line >= std::numeric_limits<std::uint32_t>::max())
    throw Refused(fmt::format("there is no line {}: lines are counted from {}", line, line_base_));
  return static_cast<std::uint32_t>(line);
}

// --- the life of a session ---

Json Session::initialize(const Json& arguments) {
  line_base_ = truth_at(arguments, "linesStartAt1", true) ? 1 : 0;
  column_base_ = truth_at(arguments, "columnsStartAt1", true) ? 1 : 0;
  client_shows_progress_ = truth_at(arguments, "supportsProgressReporting", false);
  client_takes_memory_events_ = truth_at(arguments, "supportsMemoryEvent", false);
  client_takes_invalidation_ = truth_at(arguments, "supportsInvalidatedEvent", false);
  const std::string format = text_at(arguments, "pathFormat", "path");
  if (format != "path" && format != "uri")
    throw Refused(fmt::format("pathFormat: '{}' is not path or uri", stl::shortened(format)));
  client_takes_uris_ = format == "uri";
  return capabilities();
}

Json Session::launch(const Json& arguments) {
  if (debuggee_) throw Refused("a program is being debugged already");
  read_attributes(arguments, false);
  begin(settings_.launch(arguments));
  note_without_effect(arguments, {AttributeUse::OfOthers}, "of other debuggers");
  begun_with_ = arguments;
  return {};
}

Json Session::attach(const Json& arguments) {
  if (debuggee_) throw Refused("a program is being debugged already");
  if (!settings_.attachable)
    throw Refused(
        "there is no PLC to attach to: it is the one that s7200 dap is started with, for example s7200 dap --listen 4711 "
        "PROGRAM; launch brings its own");
  read_attributes(arguments, true);
  begin(settings_.attachable);
  Json rest = arguments;
  rest.erase("port");  // where the server is: for the editor
  note_without_effect(rest, {AttributeUse::OfOthers, AttributeUse::Program},
                      "the command line of s7200 dap says how this PLC runs");
  begun_with_ = arguments;
  attached_ = true;
  return {};
}

/// What a launch or an attach says to the session itself.
void Session::read_attributes(const Json& arguments, bool stops_on_entry) {
  stop_on_entry_ = truth_at(arguments, "stopOnEntry", stops_on_entry);
  no_debug_ = truth_at(arguments, "noDebug", false);
  const std::string unit = text_at(arguments, "step", "line");
  if (unit != "line" && unit != "network") throw Refused(fmt::format("step: '{}' is not line or network", unit));
  steps_are_networks_ = unit == "network";
  const auto station = number_at<std::int64_t>(arguments, "station", kWhole<std::int64_t>, 1);
  if (station < 0 || station > 255) throw Refused(fmt::format("station: {} is not from 0 to 255", station));
  slave_ = static_cast<std::uint8_t>(station);
  folder_ = text_at(arguments, "cwd", "");
  read_frames(arguments);
}

/// One line for all of them.
void Session::note_without_effect(const Json& arguments, std::initializer_list<AttributeUse> uses, const std::string& why) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : arguments.items()) {
    const bool is_one = std::ranges::find(uses, use_of(key)) != uses.end();
    if (is_one && !value.is_null()) keys.push_back(key);
  }
  if (!keys.empty())
    print(fmt::format("without effect here ({}): {}", why, stl::joined(keys, std::identity{})), "important");
}

void Session::begin(std::shared_ptr<Debuggee> debuggee) {
  SessionSetup setup = debuggee->setup();
  if (!frames_.empty() && !debuggee->history().station(setup.station).has_master())
    throw Refused(fmt::format("send: {}", kNoRoomForMaster));
  setup.stop_request = settings_.stop_request;
  setup.slave = slave_;
  debuggee_ = std::move(debuggee);
  session_ = std::make_unique<tools::Session>(debuggee_->history(), std::move(setup), static_cast<Onlooker&>(*this));
  sources_.clear();
  for (std::size_t station = 0; station < stations(); ++station)
    sources_.emplace_back(program_of(station), client_takes_uris_);
  session_->stepper.set_host_timeout(master().timeout);
  debuggee_->when_saying([this](const std::string& text) { print(text, "important"); });
  session_->stepper.on_message = [this](const StopPoint& stop, const Hit& hit) {
    const Cpu& at = debuggee_->history().station(stop.station).cpu();
    print_of(stop.station, message_text(stop, hit, at, debuggee_->history().now().time), "console", standing_at(at.state()));
  };
  after_response([this] { send_event("initialized", {}); });
}

/// The frames that a launch or an attach asks for.
void Session::read_frames(const Json& arguments) {
  frames_.clear();
  for (const std::string& text : texts_at(arguments, "send")) {
    std::string why;
    const auto frame = parse_frame(text, slave_, why);
    if (!frame) throw Refused(fmt::format("'{}': {}", stl::shortened(text), why));
    frames_.push_back(*frame);
  }
  const std::string after = text_at(arguments, "sendAfter", "");
  const auto time = after.empty() ? std::optional(kSendAfter) : parse_duration(after);
  if (!time) throw Refused(fmt::format("sendAfter: '{}' is not a duration; write for example 250ms", stl::shortened(after)));
  send_after_ = *time;
}

Json Session::configuration_done(const Json&) {
  after_response([this] { start(); });
  return {};
}

void Session::start() {
  const std::string mode = attached_ ? "attach" : "launch";
  send_event("process", {{"name", debuggee_->source()}, {"isLocalProcess", false}, {"startMethod", mode}});
  if (!stop_on_entry_) return run_to(goal::none(), "");
  if (attached_ && standing_at(cpu().state())) return stopped_at("entry", "attached");
  run_to([](const State&, std::uint32_t, const Stepper::Progress&) { return true; }, "entry");
}

/// Of a launch or an attach that has changed since: what is about the session itself; the program is the one that is loaded.
void Session::take_changed_arguments(const Json& arguments) {
  read_attributes(arguments, attached_);
  session_->setup.slave = slave_;
  std::vector<std::string> changed;
  for (const auto& [key, value] : arguments.items())
    if (use_of(key) == AttributeUse::Program && begun_with_.value(key, Json()) != value) changed.push_back(key);
  for (const auto& [key, value] : begun_with_.items())
    if (use_of(key) == AttributeUse::Program && !arguments.contains(key)) changed.push_back(key);
  if (!changed.empty())
    print(fmt::format(
              "restart: the program that is loaded powers up again; for another {} end the session and begin a new one",
              stl::joined(changed, std::identity{})),
          "important");
}

Json Session::restart(const Json& arguments) {
  if (member(arguments, "arguments")) take_changed_arguments(map_at(arguments, "arguments"));
  running_.reset();
  pause_asked_ = false;
  executed({"restart"});
  frames_sent_.clear();
  after_response([this] {
    if (!stop_on_entry_) send_event("continued", {{"threadId", thread()}, {"allThreadsContinued", true}});
    start();
  });
  return {};
}

Json Session::terminate(const Json&) {
  running_.reset();
  after_response([this] { end_debuggee(); });
  return {};
}

/// The program that a launch began ends; one that was attached to stays as it stands.
void Session::end_debuggee() {
  if (!debuggee_ || terminated_) return;
  terminated_ = true;
  leave();
  bool fatal = false;
  for (std::size_t station = 0; station < stations(); ++station)
    fatal |= debuggee_->history().station(station).cpu().state().fatal_code != 0;
  if (!attached_) send_event("exited", {{"exitCode", fatal ? 3 : 0}});
  send_event("terminated", {});
}

void Session::leave() {
  if (!attached_)
    for (const std::string& text : debuggee_->finish()) print(text, "important");
  debuggee_->when_saying([](const std::string&) {});
}

Json Session::disconnect(const Json&) {
  running_.reset();
  over_ = true;
  if (debuggee_ && !terminated_) leave();
  terminated_ = true;
  return {};
}

void Session::abandon() {
  running_.reset();
  send_ = [](const Json&) {};
  if (debuggee_ && !terminated_) leave();
  terminated_ = over_ = true;
}

/// What was to be cancelled has been: it is interrupted, or was refused, before its turn.
Json Session::cancel(const Json&) { return {}; }

}  // namespace s7200::tools::dap
