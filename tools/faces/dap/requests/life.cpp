// The life of a conversation: what a launch or an attach brings, and how it ends.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "interpreter/base/text/joined.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/faces/dap/exception_filters.hpp"
#include "tools/faces/dap/requests.hpp"
#include "tools/faces/dap/wire/conversation.hpp"
#include "tools/session/stops/goals.hpp"
#include "tools/session/stops/stop_words.hpp"
#include "tools/session/words/frame_words.hpp"
#include "tools/session/words/line_words.hpp"

namespace s7200::tools::dap {
namespace {

constexpr Time kSendAfter = kSecond;  // every program has set its port up by then

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

Json initialize(Conversation& talk, const Json& arguments) {
  talk.client.line_base = truth_at(arguments, "linesStartAt1", true) ? 1 : 0;
  talk.client.column_base = truth_at(arguments, "columnsStartAt1", true) ? 1 : 0;
  talk.client.shows_progress = truth_at(arguments, "supportsProgressReporting", false);
  talk.client.takes_memory_events = truth_at(arguments, "supportsMemoryEvent", false);
  talk.client.takes_invalidation = truth_at(arguments, "supportsInvalidatedEvent", false);
  const std::string format = text_at(arguments, "pathFormat", "path");
  if (format != "path" && format != "uri")
    throw Refused(fmt::format("pathFormat: '{}' is not path or uri", stl::shortened(format)));
  talk.client.takes_uris = format == "uri";
  return capabilities();
}

/// The frames that a launch or an attach asks for.
void read_frames(Conversation& talk, const Json& arguments) {
  talk.begun.frames.clear();
  for (const std::string& text : texts_at(arguments, "send")) {
    const auto frame = parse_frame(text, talk.begun.slave);
    if (!frame) throw Refused(fmt::format("'{}': {}", stl::shortened(text), frame.why()));
    talk.begun.frames.push_back(*frame);
  }
  const std::string after = text_at(arguments, "sendAfter", "");
  const auto time = after.empty() ? std::optional(kSendAfter) : parse_duration(after);
  if (!time) throw Refused(fmt::format("sendAfter: '{}' is not a duration; write for example 250ms", stl::shortened(after)));
  talk.begun.send_after = *time;
}

/// What a launch or an attach says to the session itself.
void read_attributes(Conversation& talk, const Json& arguments, bool stops_on_entry) {
  talk.begun.stop_on_entry = truth_at(arguments, "stopOnEntry", stops_on_entry);
  talk.begun.no_debug = truth_at(arguments, "noDebug", false);
  const std::string unit = text_at(arguments, "step", "line");
  if (unit != "line" && unit != "network") throw Refused(fmt::format("step: '{}' is not line or network", unit));
  talk.begun.steps_are_networks = unit == "network";
  const auto station = number_at<std::int64_t>(arguments, "station", kWhole<std::int64_t>, 1);
  if (station < 0 || station > 255) throw Refused(fmt::format("station: {} is not from 0 to 255", station));
  talk.begun.slave = static_cast<std::uint8_t>(station);
  talk.begun.folder = text_at(arguments, "cwd", "");
  read_frames(talk, arguments);
}

/// One line for all of them.
void note_without_effect(Conversation& talk, const Json& arguments, std::initializer_list<AttributeUse> uses,
                         const std::string& why) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : arguments.items()) {
    const bool is_one = std::ranges::find(uses, use_of(key)) != uses.end();
    if (is_one && !value.is_null()) keys.push_back(key);
  }
  if (!keys.empty())
    talk.print(fmt::format("without effect here ({}): {}", why, stl::joined(keys, std::identity{})), "important");
}

void begin(Conversation& talk, std::shared_ptr<Debuggee> debuggee) {
  SessionSetup setup = debuggee->setup();
  if (!talk.begun.frames.empty() && !debuggee->history().station(setup.station).has_master())
    throw Refused(fmt::format("send: {}", kNoRoomForMaster));
  setup.stop_request = talk.settings.stop_request;
  setup.slave = talk.begun.slave;
  talk.debuggee = std::move(debuggee);
  talk.session = std::make_unique<tools::Session>(talk.debuggee->history(), std::move(setup), static_cast<Onlooker&>(talk));
  talk.sources_of.clear();
  for (std::size_t station = 0; station < talk.stations(); ++station)
    talk.sources_of.emplace_back(talk.program_of(station), talk.client.takes_uris);
  talk.session->stepper.set_host_timeout(talk.master().timeout);
  talk.debuggee->when_saying([&talk](const std::string& text) { talk.print(text, "important"); });
  talk.session->stepper.on_message = [&talk](const StopPoint& stop, const Hit& hit) {
    const Cpu& at = talk.debuggee->history().station(stop.station).cpu();
    talk.print_of(stop.station, message_text(stop, hit, at, talk.debuggee->history().now().time), "console",
                  standing_at(at.state()));
  };
  talk.after_response([&talk] { talk.send_event("initialized", {}); });
}

Json launch(Conversation& talk, const Json& arguments) {
  if (talk.debuggee) throw Refused("a program is being debugged already");
  read_attributes(talk, arguments, false);
  begin(talk, talk.settings.launch(arguments));
  note_without_effect(talk, arguments, {AttributeUse::OfOthers}, "of other debuggers");
  talk.begun.with = arguments;
  return {};
}

Json attach(Conversation& talk, const Json& arguments) {
  if (talk.debuggee) throw Refused("a program is being debugged already");
  if (!talk.settings.attachable)
    throw Refused(
        "there is no PLC to attach to: it is the one that s7200 dap is started with, for example s7200 dap --listen 4711 "
        "PROGRAM; launch brings its own");
  read_attributes(talk, arguments, true);
  begin(talk, talk.settings.attachable);
  Json rest = arguments;
  rest.erase("port");  // where the server is: for the editor
  note_without_effect(talk, rest, {AttributeUse::OfOthers, AttributeUse::Program},
                      "the command line of s7200 dap says how this PLC runs");
  talk.begun.with = arguments;
  talk.begun.attached = true;
  return {};
}

Json configuration_done(Conversation& talk, const Json&) {
  talk.after_response([&talk] { start(talk); });
  return {};
}

/// Of a launch or an attach that has changed since: what is about the session itself; the program is the one that is loaded.
void take_changed_arguments(Conversation& talk, const Json& arguments) {
  read_attributes(talk, arguments, talk.begun.attached);
  talk.session->setup.slave = talk.begun.slave;
  std::vector<std::string> changed;
  for (const auto& [key, value] : arguments.items())
    if (use_of(key) == AttributeUse::Program && talk.begun.with.value(key, Json()) != value) changed.push_back(key);
  for (const auto& [key, value] : talk.begun.with.items())
    if (use_of(key) == AttributeUse::Program && !arguments.contains(key)) changed.push_back(key);
  if (!changed.empty())
    talk.print(fmt::format(
                   "restart: the program that is loaded powers up again; for another {} end the session and begin a new one",
                   stl::joined(changed, std::identity{})),
               "important");
}

Json restart(Conversation& talk, const Json& arguments) {
  if (member(arguments, "arguments")) take_changed_arguments(talk, map_at(arguments, "arguments"));
  talk.running.reset();
  talk.pause_asked = false;
  executed(talk, {"restart"});
  talk.frames_sent.clear();
  talk.after_response([&talk] {
    if (!talk.begun.stop_on_entry)
      talk.send_event("continued", {{"threadId", talk.thread()}, {"allThreadsContinued", true}});
    start(talk);
  });
  return {};
}

Json terminate(Conversation& talk, const Json&) {
  talk.running.reset();
  talk.after_response([&talk] { end_debuggee(talk); });
  return {};
}

Json disconnect(Conversation& talk, const Json&) {
  talk.running.reset();
  talk.over = true;
  if (talk.debuggee && !talk.terminated) leave(talk);
  talk.terminated = true;
  return {};
}

/// What was to be cancelled has been: it is interrupted, or was refused, before its turn.
Json cancel(Conversation&, const Json&) { return {}; }

}  // namespace

void start(Conversation& talk) {
  const std::string mode = talk.begun.attached ? "attach" : "launch";
  talk.send_event("process", {{"name", talk.debuggee->source()}, {"isLocalProcess", false}, {"startMethod", mode}});
  if (!talk.begun.stop_on_entry) return run_to(talk, goal::none(), "");
  if (talk.begun.attached && standing_at(talk.cpu().state())) return stopped_at(talk, "entry", "attached");
  run_to(
      talk, [](const State&, std::uint32_t, const Stepper::Progress&) { return true; }, "entry");
}

void end_debuggee(Conversation& talk) {
  if (!talk.debuggee || talk.terminated) return;
  talk.terminated = true;
  leave(talk);
  bool fatal = false;
  for (std::size_t station = 0; station < talk.stations(); ++station)
    fatal |= talk.debuggee->history().station(station).cpu().state().fatal_code != 0;
  if (!talk.begun.attached) talk.send_event("exited", {{"exitCode", fatal ? 3 : 0}});
  talk.send_event("terminated", {});
}

void leave(Conversation& talk) {
  if (!talk.begun.attached)
    for (const std::string& text : talk.debuggee->finish()) talk.print(text, "important");
  talk.debuggee->when_saying([](const std::string&) {});
}

std::vector<Request> life_requests() {
  return {{"initialize", initialize, Needs::Nothing},
          {"launch", launch, Needs::Nothing},
          {"attach", attach, Needs::Nothing},
          {"configurationDone", configuration_done},
          {"restart", restart},
          {"terminate", terminate},
          {"disconnect", disconnect, Needs::Nothing},
          {"cancel", cancel, Needs::Nothing}};
}

}  // namespace s7200::tools::dap
