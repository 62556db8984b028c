// Commands of a session, in the debug console and as requests of our own, and the two requests that are like them.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <tuple>
#include <utility>

#include "interpreter/base/result.hpp"
#include "interpreter/base/text/joined.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/faces/dap/requests.hpp"
#include "tools/faces/dap/wire/conversation.hpp"
#include "tools/session/causes/expression.hpp"
#include "tools/session/commands/answers/cause_reports.hpp"
#include "tools/session/commands/answers/status.hpp"
#include "tools/session/commands/rows/command_table.hpp"
#include "tools/session/words/words.hpp"

namespace s7200::tools::dap {
namespace {

/// A request that is a command.
struct CommandRequest {
  std::string_view request, command, argument;
  bool is_needed = false;             ///< the argument
  std::string_view description = {};  ///< of the stop, if it goes back
  bool is_told = false;               ///< what it says is not in the response
};

constexpr CommandRequest kCommandRequests[] = {
    {"sendFrame", "send", "frame", true, {}, true},
    {"fault", "fault", "fault", true},
    {"force", "force", "values"},
    {"unforce", "unforce", "places", true},
    {"lastWrite", "who", "expression", true},
    {"reverseToLastWrite", "rwho", "expression", true, "in front of the last write"},
    {"lastDecision", "why", ""},
    {"whyNot", "why not", "condition", true},
    {"effect", "effect", "expression", true},
    {"reverseToLastDecision", "rwhy", "", false, "in front of what decided"},
    {"lastInstructions", "history", "count"},
};

/// The words of an argument: a text with blanks between its words, a list of them, or a number.
Words words_in(const Json& arguments, const CommandRequest& row) {
  const std::string key(row.argument);
  const Json* const value = key.empty() ? nullptr : member(arguments, key.c_str());
  if (value && value->is_number()) return {shown(*value)};
  Words words;
  if (value)
    for (const std::string& text : texts_at(arguments, key.c_str()))
      std::ranges::copy(command_words(text), std::back_inserter(words));
  if (row.is_needed && words.empty()) throw Refused(fmt::format("{} is missing", key));
  return words;
}

/// What is wrong, without the name of the command, which a request has not: `'read 11:2': …`, `expected one address, …`
std::string without_command(std::string error, const Words& command) {
  const std::string& name = command.front();
  const std::string given = joined({command.begin() + 1, command.end()});
  for (const auto& [from, to] :
       {std::pair(name + " cancel: ", std::string()), std::pair(name + ": ", std::string()),
        std::pair(fmt::format("{} {}: ", name, given), fmt::format("'{}': ", stl::shortened(given)))})
    if (error.starts_with(from)) return to + error.substr(from.size());
  const std::string expects = name + " expects";
  if (const std::size_t at = error.find(expects); at != std::string::npos) error.replace(at, expects.size(), "expected");
  return error;
}

constexpr std::string_view kAboutExpressions =
    "An expression in STL terms shows its value: VW100, VB0:16, *VD3570:word, VW2 * 2 + 1, M31.7 and VW3300 > 8.\n";

std::set<int> stop_numbers(Conversation& talk) {
  std::set<int> numbers;
  for (const StopPoint& stop : talk.session->stepper.stops()) numbers.insert(stop.number);
  return numbers;
}

/// A command has set or removed some.
void note_changed_stops(Conversation& talk, const std::set<int>& before) {
  const std::set<int> now = stop_numbers(talk);
  const auto tell_of = [&talk](const std::set<int>& of, const std::set<int>& others, const char* reason) {
    for (const int number : of)
      if (!others.contains(number))
        talk.send_event("breakpoint", {{"reason", reason}, {"breakpoint", {{"id", number}, {"verified", true}}}});
  };
  tell_of(now, before, "new");
  tell_of(before, now, "removed");
  for (const int number : before)
    if (!now.contains(number)) talk.placed.erase(number);
}

/// Puts how the client calls a place for the numbers of instructions.
Json placed(Conversation& talk, Json json) {
  for (Json& part : json)
    if (part.is_structured()) part = placed(talk, std::move(part));
  if (!json.is_object() || !json.contains("op")) return json;
  const Json place = talk.client_place(json["op"].get<std::uint32_t>());
  json.erase("op");
  json.update(place);
  return json;
}

/// Executes a command, and tells the client what has come of it but for where the session stands now.
Reply done(Conversation& talk, const Words& command) {
  const std::set<int> stops = stop_numbers(talk);
  const History::Place before = talk.debuggee->history().here();
  Reply reply = execute(*talk.session, command);
  const History::Place now = talk.debuggee->history().here();
  note_branch(talk, before.branch);
  note_changed_stops(talk, stops);
  if (now.branch != before.branch || now.moment.actions != before.moment.actions) note_change(talk);
  if (reply.interrupted) refuse_interrupted();
  if (reply.error) talk.print(reply.text);
  return reply;
}

/// What one command says.
std::string said_by(Conversation& talk, const std::string& command) {
  const Words words = command_words(command);
  const Reply reply = executed(talk, words);
  const bool is_help = words.size() == 1 && talk.session->command == "help";
  return (is_help ? std::string(kAboutExpressions) : "") + (reply.text.empty() ? text_in(reply.json, "text") : reply.text);
}

/// What has come of what was typed.
void report_console(Conversation& talk, bool has_moved) {
  if (!has_moved && !talk.session->quit_asked) return;
  talk.running.reset();
  talk.after_response([&talk, station = talk.looks_at(), command = talk.session->command] {
    if (talk.session->quit_asked) return end_debuggee(talk);
    talk.session->stepper.look_at(station);
    stopped_at(talk, "step", command);
  });
}

/// Of the last exchange, unless `from` names an earlier moment.
Json timeline(Conversation& talk, const Json& arguments) {
  const serial::Exchange exchange =
      talk.simulation().has_master() ? talk.simulation().master().exchange() : serial::Exchange{};
  Time from = exchange.request_start;
  if (member(arguments, "from")) {
    const auto time = parse_duration(text_at(arguments, "from"));
    if (!time) throw Refused("from must be a time, such as 15.193ms");
    from = *time;
  }
  const Reply reply = timeline_since(*talk.session, from, exchange);
  if (reply.interrupted) refuse_interrupted();
  return reply.json;
}

/// What each instruction of some lines did when it was last executed.
Json stl_status(Conversation& talk, const Json& arguments) {
  const std::string path = talk.source_path(arguments);
  const LookAt look(talk, talk.station_with(path));
  const auto first_line = talk.sources().line_in(path, talk.line_of_client(talk.client_line_in(arguments)));
  const auto last_line = talk.sources().line_in(path, talk.line_of_client(talk.client_line_in(arguments, "endLine")));
  const auto first = first_line ? talk.listing().op_from_line(*first_line) : std::nullopt;
  if (!first) return {{"lines", Json::array()}};
  auto end = static_cast<std::uint32_t>(talk.cpu().program().ops.size());
  while (last_line && end > *first && talk.listing().line_of(end - 1) > *last_line) --end;
  Json body = status_json(*talk.session, last_executions_of(*talk.session, *first, end));
  for (Json& line : body["lines"])
    line = {{"line", talk.client_place(line["op"].get<std::uint32_t>())["line"]},
            {"powerFlow", line["powerFlow"]},
            {"text", line["text"]}};
  return body;
}

}  // namespace

Reply executed(Conversation& talk, const Words& command) {
  Reply reply = done(talk, command);
  if (reply.error) throw Refused(*reply.error);
  return reply;
}

Json run_command(Conversation& talk, const std::string& request, const Json& arguments) {
  const CommandRequest& row = *std::ranges::find(kCommandRequests, request, &CommandRequest::request);
  Words words = words_in(arguments, row);
  const Words command = command_words(std::string(row.command));
  words.insert(words.begin(), command.begin(), command.end());
  const Reply reply = done(talk, words);
  if (reply.error) throw Refused(without_command(*reply.error, words));
  Json body = placed(talk, reply.json);
  const std::string why = text_in(body, "whyNoMoment");
  if (body.contains("whyNoMoment")) body.erase("whyNoMoment");
  if (row.description.empty()) {
    if (row.is_told) talk.print(reply.text);
    return body;
  }
  const std::string text = text_in(body, "text");
  if (!reply.moved) throw Refused(why.empty() ? text : text + "\n" + why);
  talk.after_response([&talk, text, description = std::string(row.description)] {
    talk.print(text);
    stopped_at(talk, "step", description);
  });
  return body;
}

bool is_command(const std::string& line, const Program& program) {
  const std::vector<std::string> commands = commands_in(line);
  const Words words = commands.empty() ? Words() : command_words(commands.front());
  const auto command = words.empty() ? Trouble{} : find_command(words.front());
  if (!command) return false;
  return stl::lower_case(words.front()) == command->name || !Expression::parse(commands.front(), program);
}

Json console(Conversation& talk, const std::string& line) {
  const auto where = [&talk] {
    const Moment now = talk.debuggee->history().now();
    return std::tuple(talk.debuggee->history().here().branch, now.instructions, now.time, talk.looks_at());
  };
  const auto before = where();
  std::string text;
  try {
    for (const std::string& command : commands_in(line)) text += said_by(talk, command);
  } catch (const Refused&) {
    talk.print(text);
    report_console(talk, where() != before);
    throw;
  }
  report_console(talk, where() != before);
  return {{"result", text}, {"variablesReference", 0}};
}

std::vector<Request> commands_requests() {
  std::vector<Request> all{{"timeline", timeline}, {"stlStatus", stl_status}};
  for (const CommandRequest& row : kCommandRequests)
    all.push_back({row.request, nullptr, row.description.empty() ? Needs::Program : Needs::Standstill});
  return all;
}

}  // namespace s7200::tools::dap
