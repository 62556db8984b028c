#include "tools/faces/dap/wire/conversation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "tools/faces/dap/requests.hpp"

namespace s7200::tools::dap {
namespace {

constexpr std::string_view kCancelled = "cancelled";  // as the protocol says it

/// VS Code pops up what the user is to see. What it asks while he types, points or steps has its own place for a refusal,
/// and it is VS Code that cancels.
bool pops_up(std::string_view command, std::string_view message) {
  return command != "evaluate" && command != "stlStatus" && message != kCancelled;
}

}  // namespace

void Conversation::respond(const Json& request, bool success, Json body, const std::string& message) {
  Json response{{"seq", ++sent},
                {"type", "response"},
                {"request_seq", number_in(request, "seq")},
                {"success", success},
                {"command", text_in(request, "command")}};
  if (!success) {
    response["message"] = message;
    body = {{"error", {{"id", 1}, {"format", message}, {"showUser", pops_up(text_in(request, "command"), message)}}}};
  }
  if (!body.is_null()) response["body"] = std::move(body);
  send(response);
}

void Conversation::send_event(const std::string& event, Json body) {
  Json message{{"seq", ++sent}, {"type", "event"}, {"event", event}};
  if (!body.is_null()) message["body"] = std::move(body);
  send(message);
}

/// The first one that has the file in its program; the one looked at if it has it too, or none has.
std::size_t Conversation::station_with(const std::string& path) const {
  const auto has = [&](std::size_t station) { return sources_of[station].line_in(path, 1).has_value(); };
  for (std::size_t station = 0; station < stations() && !has(looks_at()); ++station)
    if (has(station)) return station;
  return looks_at();
}

void Conversation::print_of(std::size_t station, const std::string& text, const std::string& category,
                            std::optional<std::uint32_t> op) {
  const LookAt look(*this, station);
  print(said_of(station) + text, category, op);
}

void Conversation::print(const std::string& text, const std::string& category, std::optional<std::uint32_t> op) {
  if (text.empty()) return;
  Json body{{"category", category}, {"output", text.ends_with('\n') ? text : text + "\n"}};
  if (op) body.update(client_place(*op));
  send_event("output", std::move(body));
}

Json Conversation::client_place(std::uint32_t op) const {
  const stl::Position& position = cpu().program().statement(op).position;
  Json place = sources().place_of(position.line);
  place["line"] = client_line(place["line"].get<std::uint32_t>());
  place["column"] = std::max(position.column, 1u) - 1 + client.column_base;
  return place;
}

/// The full name of the file that a request is about.
std::string Conversation::source_path(const Json& arguments) const {
  return full_name(text_at(required_map(arguments, "source"), "path", ""), begun.folder);
}

/// As the client counts lines.
std::uint32_t Conversation::client_line_in(const Json& arguments, const char* key) const {
  const auto line = number_at<std::int64_t>(arguments, key);
  if (line < std::int64_t{client.line_base} || line >= std::numeric_limits<std::uint32_t>::max())
    throw Refused(fmt::format("there is no line {}: lines are counted from {}", line, client.line_base));
  return static_cast<std::uint32_t>(line);
}

void refuse_interrupted() { throw Refused(std::string(kCancelled)); }

}  // namespace s7200::tools::dap
