#include "tools/faces/page/conversation.hpp"

#include <utility>

#include "tools/session/commands/answers/moments_json.hpp"
#include "tools/session/commands/rows/command_table.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools::page {
namespace {

/// In one line; a text that is not UTF-8, such as a name in a file, has replacement characters.
std::string message_of(const Json& json) { return line_of(json); }

Json event(std::string_view name) { return {{"event", name}}; }

/// A text in a message; nothing of another kind, or without it.
const std::string* text_in(const Json& message, const char* key) {
  const auto found = message.find(key);
  return found == message.end() ? nullptr : found->get_ptr<const std::string*>();
}

Json id_of(const Json& message) {
  const auto found = message.find("id");
  return found != message.end() && (found->is_number() || found->is_string()) ? *found : Json();
}

/// A piece of a run after which it goes on: its length has passed, an answer has come, or it gave way to a command.
bool goes_on(const Reply& reply) {
  if (reply.error) return false;
  const std::string* const stopped = text_in(reply.json, "stopped");
  return reply.interrupted || (stopped && (*stopped == "limit" || *stopped == "answer"));
}

Json reply_json(const Json& id, const Reply& reply) {
  Json json{{"id", id}, {"text", reply.text}, {"json", reply.json}, {"moved", reply.moved}};
  if (reply.interrupted) json["interrupted"] = true;
  if (reply.error) json["error"] = *reply.error;
  return json;
}

}  // namespace

/// What a command may change without moving the session.
struct Conversation::Seen {
  History::Place place;
  std::size_t actions, stops, focus, displayed;

  bool operator==(const Seen& other) const {
    return place.branch == other.place.branch && actions == other.actions && stops == other.stops && focus == other.focus &&
           displayed == other.displayed;
  }
};

Conversation::Conversation(History& history, PageSettings settings, Post post)
    : settings_(std::move(settings)), post_(std::move(post)), session_(history, settings_.session, *this) {
  session_.stepper.pause_when(settings_.pause);
  session_.failed = {session_.focus(), session_.history.now(), settings_.failed};
}

Conversation::Seen Conversation::seen() const {
  const History& history = session_.history;
  return {history.here(), history.usage().forgotten + history.actions().size(), session_.stepper.stops().size(),
          session_.focus(), session_.displayed.size()};
}

void Conversation::greet(Client client) const {
  Json stations = Json::array(), may = Json::array();
  for (const DebuggedStation& station : session_.setup.stations) stations.push_back(station.name);
  if (session_.setup.files) may.push_back("files");
  Json hello = event("hello");
  hello["protocol"] = kProtocol;
  hello["version"] = version();
  hello["program"] = settings_.program;
  hello["cpu"] = session_.program().model->name;
  hello["stations"] = std::move(stations);
  hello["may"] = std::move(may);
  hello["live"] = settings_.live;
  hello["now"] = moments_json(session_);
  if (runs_ > 0 || runner_) hello["running"] = running_;
  if (!settings_.found.empty()) hello["found"] = settings_.found;
  post_.to(client, message_of(hello));
}

void Conversation::handle(Client client, const Json& message, bool undone) {
  if (message.contains("stop")) return end_run();
  const std::string* const command = text_in(message, "command");
  if (!command) return complain(client, "a message has a command: {\"id\": 1, \"command\": \"step\"}");
  const std::string* const run = text_in(message, "run");
  const Reply reply = run      ? carry_on(client, *command, *run == "begins", undone)
                      : undone ? Reply{.interrupted = true}
                               : carry_out(*command, false);
  Json json = reply_json(id_of(message), reply);
  if (undone) json["undone"] = true;
  post_.to(client, message_of(json));
}

/// A piece of a run. One run goes on at a time: another one is not begun, and one that somebody else has ended is over.
Reply Conversation::carry_on(Client client, const std::string& line, bool begins, bool undone) {
  if (begins && (runs_ > 0 || (runner_ && *runner_ != client))) return {.error = "a run goes on already; Pause ends it"};
  if (begins) {
    runner_ = client;
    runner_left_ = false;
  }
  if (undone || runner_ != client) return {.interrupted = true};
  Reply reply = carry_out(line, true);
  if (!goes_on(reply) || runner_left_) end_run();
  return reply;
}

/// Everyone is told, as nobody else knows that no further piece comes.
void Conversation::end_run() {
  if (!std::exchange(runner_, {})) return;
  tell_all(event("stopped"));
}

/// One that follows the clock goes on for the other windows.
void Conversation::leave(Client client) {
  if (runner_ != client) return;
  if (runs_ > 0)
    runner_left_ = true;
  else
    end_run();
}

/// Up to the first wrong command of the line, or to a stop.
Reply Conversation::carry_out(const std::string& line, bool of_run) {
  Reply all;
  for (const std::string& one : commands_in(line)) {
    const Seen before = seen();
    Reply reply = execute(session_, command_words(one));
    reply.interrupted |= session_.stop_requested();
    all.text += reply.text;
    all.json = std::move(reply.json);
    all.moved |= reply.moved;
    all.interrupted = reply.interrupted;
    all.error = std::move(reply.error);
    if (reply.moved) tell_moved(of_run && runner_ && goes_on(all) ? "" : one);
    tell_what_changed(before, one);
    if (all.error || all.interrupted || is_over()) break;
  }
  return all;
}

void Conversation::tell_what_changed(const Seen& before, const std::string& command) {
  if (seen() == before) return;
  Json changed = event("changed");
  changed["by"] = command;
  tell_all(std::move(changed));
}

void Conversation::complain(Client client, const std::string& why) const {
  post_.to(client, message_of({{"id", nullptr}, {"error", why}}));
}

void Conversation::say(const std::string& lines) {
  if (lines.empty()) return;
  Json printed = event("printed");
  printed["text"] = lines;
  tell_all(std::move(printed));
}

void Conversation::end(const std::string& why) {
  Json ended = event("ended");
  ended["why"] = why;
  tell_all(std::move(ended));
}

void Conversation::tell_all(Json event) const { post_.to_all(message_of(event)); }

void Conversation::tell_moved(const std::string& by) const {
  Json moved = event("moved");
  moved["now"] = moments_json(session_);
  moved["by"] = by;
  tell_all(std::move(moved));
}

// --- while a run goes on ---

void Conversation::run_begins(bool /*of_all*/) {
  if (runs_ == 0) running_ = session_.command;
  Json running = event("running");
  running["command"] = session_.command;
  tell_all(std::move(running));
  if (settings_.clock) news_at_ = settings_.clock() + kNews;
  ++runs_;
  if (settings_.live && settings_.live_run) settings_.live_run(true);
}

void Conversation::run_ended() {
  if (--runs_ == 0 && settings_.live && settings_.live_run) settings_.live_run(false);
}

/// Asking the clock takes as long as some instructions. A run that follows it has time for that, and few are told of: scans
/// that change nothing are passed over.
void Conversation::executed(const InstructionRecord& /*record*/) {
  const std::uint32_t often = settings_.live ? 16 : 1024;
  if (++executed_ % often != 0 || !settings_.clock) return;
  const Time now = settings_.clock();
  if (now < news_at_) return;
  news_at_ = now + kNews;
  tell_moved("");
}

/// The run goes on unless a command has moved the session.
std::optional<bool> Conversation::carry_out_asked() {
  if (!settings_.carry_out || runs_ > kDeepest || session_.stop_requested()) return {};
  const History::Place place = session_.history.here();
  const std::string command = session_.command;
  say(session_.take_said());
  if (!settings_.carry_out()) return {};
  session_.command = command;
  const History::Place here = session_.history.here();
  return !is_over() && !session_.stop_requested() && here.branch == place.branch &&
         here.moment.instructions == place.moment.instructions && here.moment.time == place.moment.time;
}

}  // namespace s7200::tools::page
