// Commands of a session, in the debug console and as requests of our own, and the two requests that are like them.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <tuple>
#include <utility>

#include "interpreter/base/joined.hpp"
#include "interpreter/base/numbers.hpp"
#include "interpreter/base/text.hpp"
#include "tools/faces/dap/session.hpp"
#include "tools/session/causes/expression.hpp"
#include "tools/session/commands/cause_reports.hpp"
#include "tools/session/commands/command_table.hpp"
#include "tools/session/commands/status.hpp"
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

constexpr std::string_view kAboutExpressions =
    "An expression in STL terms shows its value: VW100, VB0:16, *VD3570:word, VW2 * 2 + 1, M31.7 and VW3300 > 8.\n";

}  // namespace

/// The requests that are commands, after all others.
std::vector<Session::Request> Session::with_commands(std::vector<Request> table) {
  for (const CommandRequest& row : kCommandRequests)
    table.push_back({row.request, nullptr, row.description.empty() ? Needs::Program : Needs::Standstill});
  return table;
}

/// What it has said, and what has come of it, is told; the client does not know yet that it has moved.
Reply Session::executed(const Words& command) {
  const std::set<int> stops = stop_numbers();
  const History::BranchPtr before = debuggee_->history().here().branch;
  Reply reply = execute(*session_, command);
  note_branch(before);
  note_changed_stops(stops);
  if (reply.interrupted) refuse_interrupted();
  if (reply.error) {
    print(reply.text);
    throw Refused(*reply.error);
  }
  return reply;
}

std::set<int> Session::stop_numbers() const {
  std::set<int> numbers;
  for (const StopPoint& stop : session_->stepper.stops()) numbers.insert(stop.number);
  return numbers;
}

/// A command has set or removed some.
void Session::note_changed_stops(const std::set<int>& before) {
  const std::set<int> now = stop_numbers();
  const auto tell_of = [this](const std::set<int>& of, const std::set<int>& others, const char* reason) {
    for (const int number : of)
      if (!others.contains(number))
        send_event("breakpoint", {{"reason", reason}, {"breakpoint", {{"id", number}, {"verified", true}}}});
  };
  tell_of(now, before, "new");
  tell_of(before, now, "removed");
  for (const int number : before)
    if (!now.contains(number)) placed_.erase(number);
}

/// Puts how the client calls a place for the numbers of instructions.
Json Session::placed(Json json) const {
  for (Json& part : json)
    if (part.is_structured()) part = placed(std::move(part));
  if (!json.is_object() || !json.contains("op")) return json;
  const Json place = client_place(json["op"].get<std::uint32_t>());
  json.erase("op");
  json.update(place);
  return json;
}

Json Session::run_command(const std::string& request, const Json& arguments) {
  const CommandRequest& row = *std::ranges::find(kCommandRequests, request, &CommandRequest::request);
  Words words = words_in(arguments, row);
  words.insert(words.begin(), std::string(row.command));
  const Reply reply = executed(words);
  Json body = placed(reply.json);
  if (row.description.empty()) {
    if (row.is_told) print(reply.text);
    note_change();
    return body;
  }
  const std::string text = text_in(body, "text"), why = text_in(body, "whyNoMoment");
  if (!reply.moved) throw Refused(why.empty() ? text : text + "\n" + why);
  after_response([this, text, description = std::string(row.description)] {
    print(text);
    stopped_at("step", description);
  });
  return body;
}

// --- the debug console ---

/// A name that is a command's is that command; what is cut short may be an expression.
bool Session::is_command(const std::string& line, const Program& program) {
  const std::vector<std::string> commands = commands_in(line);
  const Words words = commands.empty() ? Words() : command_words(commands.front());
  std::string why;
  const CommandRow* const command = words.empty() ? nullptr : find_command(words.front(), why);
  if (!command) return false;
  return stl::lower_case(words.front()) == command->name || !Expression::parse(commands.front(), program, why);
}

/// What one command says.
std::string Session::said_by(const std::string& command) {
  const Words words = command_words(command);
  const Reply reply = executed(words);
  const bool is_help = words.size() == 1 && session_->command == "help";
  return (is_help ? std::string(kAboutExpressions) : "") + (reply.text.empty() ? text_in(reply.json, "text") : reply.text);
}

/// Commands, which `;` separates. Where they have moved the session, the client is told that it has stopped there.
Json Session::console(const std::string& line) {
  const auto place = [this] {
    const Moment now = debuggee_->history().now();
    return std::tuple(debuggee_->history().here().branch, now.instructions, now.time, looks_at());
  };
  const auto before = place();
  std::string text;
  try {
    for (const std::string& command : commands_in(line)) text += said_by(command);
  } catch (const Refused&) {
    print(text);
    report_console(place() != before);
    throw;
  }
  report_console(place() != before);
  return {{"result", text}, {"variablesReference", 0}};
}

/// What has come of what was typed.
void Session::report_console(bool has_moved) {
  if (!has_moved && !session_->quit_asked) return note_change();
  running_.reset();
  after_response([this, station = looks_at(), command = session_->command] {
    if (session_->quit_asked) return end_debuggee();
    session_->stepper.look_at(station);
    stopped_at("step", command);
  });
}

// --- requests that are like commands ---

/// Of the last exchange, unless `from` names an earlier moment.
Json Session::timeline(const Json& arguments) {
  const serial::Exchange exchange = simulation().has_master() ? simulation().master().exchange() : serial::Exchange{};
  Time from = exchange.request_start;
  if (member(arguments, "from")) {
    const auto time = parse_duration(text_at(arguments, "from"));
    if (!time) throw Refused("from must be a time, such as 15.193ms");
    from = *time;
  }
  const Reply reply = timeline_since(*session_, from, exchange);
  if (reply.interrupted) refuse_interrupted();
  return reply.json;
}

/// What each instruction of some lines did when it was last executed.
Json Session::stl_status(const Json& arguments) {
  const std::string path = source_path(arguments);
  const LookAt look(*this, station_with(path));
  const auto first_line = sources().line_in(path, line_of_client(client_line_in(arguments)));
  const auto last_line = sources().line_in(path, line_of_client(client_line_in(arguments, "endLine")));
  const auto first = first_line ? listing().op_from_line(*first_line) : std::nullopt;
  if (!first) return {{"lines", Json::array()}};
  auto end = static_cast<std::uint32_t>(cpu().program().ops.size());
  while (last_line && end > *first && listing().line_of(end - 1) > *last_line) --end;
  Json body = status_json(*session_, last_executions_of(*session_, *first, end));
  for (Json& line : body["lines"])
    line = {{"line", client_place(line["op"].get<std::uint32_t>())["line"]},
            {"powerFlow", line["powerFlow"]},
            {"text", line["text"]}};
  return body;
}

}  // namespace s7200::tools::dap
