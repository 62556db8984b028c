#include "tools/faces/dap/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "interpreter/base/text/text.hpp"
#include "tools/faces/dap/addresses.hpp"
#include "tools/faces/dap/requests.hpp"
#include "tools/faces/dap/wire/conversation.hpp"

namespace s7200::tools::dap {
namespace {

const std::vector<Request>& all_requests() {
  static const std::vector<Request> kTable = [] {
    std::vector<Request> all;
    for (const auto& some : {life_requests(), breakpoints_requests(), steps_requests(), seeing_requests(), memory_requests(),
                             commands_requests()})
      all.insert(all.end(), some.begin(), some.end());
    return all;
  }();
  return kTable;
}

/// The station that a request names, which does not stand in its references then; nothing if it names none.
std::optional<std::size_t> take_station(const Conversation& talk, Json& arguments) {
  std::optional<std::int64_t> station;
  const auto take_number = [&](const char* key, std::int64_t of_a_station, std::string_view what) {
    if (!member(arguments, key)) return;
    const auto number = number_at<std::int64_t>(arguments, key);
    station = number / of_a_station;
    if (number < 0 || *station >= static_cast<std::int64_t>(talk.stations()))
      throw Refused(fmt::format("there is no {} {}", what, number));
    arguments[key] = number % of_a_station;
  };
  if (member(arguments, "threadId")) station = std::int64_t{number_at<std::int32_t>(arguments, "threadId")} - 1;
  take_number("frameId", kFramesOfAStation, "frame");
  take_number("variablesReference", kContainersOfAStation, "variablesReference");
  for (const char* const key : {"memoryReference", "name"}) {
    if (!member(arguments, key) || (key == std::string_view("name") && !truth_at(arguments, "asAddress", false))) continue;
    const std::string text = text_at(arguments, key);
    const auto found = find_station(text, talk.stations());
    if (!found) throw Refused(fmt::format("'{}' is of no station of this system", stl::shortened(text)));
    station = static_cast<std::int64_t>(found->station);
    arguments[key] = found->reference;
  }
  if (!station) return {};
  if (*station < 0 || static_cast<std::size_t>(*station) >= talk.stations())
    throw Refused(fmt::format("there is no thread {}", *station + 1));
  return static_cast<std::size_t>(*station);
}

Json dispatch(Conversation& talk, const Request& request, const Json& arguments) {
  const auto handled = [&](const Json& of) {
    return request.handler ? request.handler(talk, of) : run_command(talk, std::string(request.command), of);
  };
  const bool needs_program = request.needs != Needs::Nothing, needs_standstill = request.needs == Needs::Standstill;
  if (needs_program && !talk.debuggee) throw Refused("there is no program yet: launch or attach comes first");
  if (needs_program && talk.terminated) throw Refused("the session has ended");
  if (needs_standstill && talk.runs()) throw Refused("the program runs: pause it first");
  if (!talk.debuggee) return handled(arguments);
  Json of_station = arguments;
  const auto station = take_station(talk, of_station);
  Json body;
  {
    const LookAt look(talk, station.value_or(talk.looks_at()));
    body = handled(of_station);
  }
  if (station && needs_standstill) talk.session->stepper.look_at(*station);  // there it runs, unless it was refused
  return body;
}

}  // namespace

Session::Session(SessionSettings settings, Send send)
    : talk_(std::make_unique<Conversation>(std::move(settings), std::move(send))) {}

Session::~Session() = default;

void Session::handle(const Json& message) {
  const std::string type = text_in(message, "type");
  if (type == "response" || type == "event") return;  // to nothing we have asked
  if (type != "request") return complain(fmt::format("'{}' has no type 'request'", stl::shortened(message.dump())));
  const std::string command = text_in(message, "command");
  const auto found = std::ranges::find(all_requests(), command, &Request::command);
  talk_->handling = number_in(message, "seq");
  talk_->later.clear();
  try {
    if (found == all_requests().end())
      throw Refused(fmt::format("'{}' is not a request that is offered", stl::shortened(command)));
    talk_->respond(message, true, dispatch(*talk_, *found, map_at(message, "arguments")));
  } catch (const Refused& refused) {
    talk_->respond(message, false, {}, refused.what());
  } catch (const WrongValue& wrong) {
    talk_->respond(message, false, {}, wrong.what());
  }
  for (const auto& action : std::exchange(talk_->later, {})) action();
}

void Session::refuse(const Json& message, const std::string& why) { talk_->respond(message, false, {}, why); }

void Session::complain(const std::string& wrong) { talk_->print("skipped what is not a message: " + wrong, "stderr"); }

bool Session::runs() const { return talk_->runs(); }

void Session::run() { run_on(*talk_); }

bool Session::is_over() const { return talk_->over; }

void Session::abandon() {
  talk_->running.reset();
  talk_->send = [](const Json&) {};
  if (talk_->debuggee && !talk_->terminated) leave(*talk_);
  talk_->terminated = talk_->over = true;
}

}  // namespace s7200::tools::dap
