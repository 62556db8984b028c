// The commands that ask what was before: who wrote it, why it is so, what ran.
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "interpreter/base/text/text.hpp"
#include "interpreter/trace/text/text_trace.hpp"
#include "tools/session/causes/latency_cause.hpp"
#include "tools/session/causes/memory_cause.hpp"
#include "tools/session/commands/answers/cause_reports.hpp"
#include "tools/session/commands/instruction_words.hpp"
#include "tools/session/commands/memory_words.hpp"
#include "tools/session/commands/rows/commands.hpp"
#include "tools/session/commands/running.hpp"
#include "tools/session/observers/last_instructions.hpp"
#include "tools/session/past/past_words.hpp"
#include "tools/session/words/words.hpp"
#include "tools/views/program/execution_text.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools::commands {
namespace {

/// `VW100`, or `event 8`.
FoundInPast writer_of(Session& session, const Words& arguments, std::string_view command) {
  if (const auto event = event_of(arguments)) return last_writer(session, *event);
  if (!arguments.empty() && stl::lower_case(arguments[0]) == "event") return {wrong(expects_event(command, arguments))};
  const auto place = one_range(session, arguments, command);
  return place ? last_writer(session, place->range, place->name) : FoundInPast{wrong(place.why())};
}

Reply why_not(Session& session, Words words) {
  if (words.empty()) return wrong(expects("why not", "a bit or a condition, for example: why not Q0.3, why not VW10 > 5"));
  const bool all = words.size() > 1 && stl::lower_case(words.back()) == "all";
  if (all) words.pop_back();
  const auto wish = parse_wish(joined(words), session.program());
  return wish ? obstacles_to(session, *wish, all) : wrong(fmt::format("why not: {}", wish.why()));
}

/// The answered request of a simulated master that ended last on the line of the PLC that is looked at, of those that the
/// masters know where the history stands; nothing if there is none.
std::optional<serial::Exchange> answered_last_here(const Session& session) {
  const PlcRequests& requests = session.history.requests();
  const std::size_t line = requests.line_of(session.focus(), session.simulation().port());
  const serial::Exchange* last = nullptr;
  for (const SimulatedMaster& master : requests.masters_on(line)) {
    const serial::Exchange& exchange = master.requester->exchange();
    if (exchange.latency() && (!last || last->response_start < exchange.response_start)) last = &exchange;
  }
  return last ? std::optional(*last) : std::nullopt;
}

/// Before which a master forgets its last one: when the last of them was asked.
std::optional<Time> asked_last(const Session& session) {
  const PlcRequests& requests = session.history.requests();
  std::optional<Time> last;
  for (const SimulatedMaster& master : requests.masters_on(requests.line_of(session.focus(), session.simulation().port())))
    if (const serial::Exchange& exchange = master.requester->exchange(); !exchange.request.empty())
      last = std::max(last.value_or(0), exchange.request_start);
  return last;
}

/// A request without an answer makes a master forget the one before it: it goes back to where that was known.
std::optional<serial::Exchange> answered_last(Session& session) {
  const History::Place here = session.history.here();
  std::optional<serial::Exchange> found = answered_last_here(session);
  for (auto asked = asked_last(session); !found && asked.value_or(0) > 0; found = answered_last_here(session)) {
    if (!session.history.go_to(*asked - 1)) break;
    const auto before = asked_last(session);
    asked = before && *before < *asked ? before : std::nullopt;
  }
  session.history.return_to(here);
  return found;
}

Reply why_latency(Session& session) {
  const auto exchange = answered_last(session);
  if (session.stop_requested()) return interrupted(session);
  if (!exchange) return wrong("why latency: no master in the simulation has had an answer on this line so far");
  const auto waits = latency_cause(session.history, session.focus(), *exchange, session.setup.stop_request);
  if (!waits) return interrupted(session);
  const std::string latency = format_duration(*exchange->latency());
  Reply reply{.json = {{"name", serial::to_hex(exchange->request)}, {"value", latency}, {"causes", *waits}}};
  reply.text =
      fmt::format("the answer to {} began {} after the end of the request\n", serial::to_hex(exchange->request), latency);
  for (const std::string& wait : *waits) reply.text += fmt::format("  {}\n", wait);
  if (waits->empty()) reply.text += "  no PLC on this line has sent it\n";
  return reply;
}

/// What `effect` is asked.
struct EffectWords {
  Words address{};
  std::optional<Time> at{};  ///< the moment before which the change is looked for
  Time within = RunTo::kUsualLimit;
};

/// `Q0.0 at 20ms within 5s`. Returns what is wrong; empty if nothing is.
std::string take_effect_words(Session& session, const Words& arguments, EffectWords& words) {
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string word = stl::lower_case(arguments[i]);
    if (word != "at" && word != "within") {
      words.address.push_back(arguments[i]);
      continue;
    }
    if (++i == arguments.size())
      return expects("effect", fmt::format("a time after {}, for example: effect Q0.0 {} 5s", word, word));
    if (word == "at") {
      const auto at = parse_moment(arguments[i], session.history);
      if (!at) return fmt::format("effect: {}", at.why());
      words.at = *at;
      continue;
    }
    const auto within = parse_duration(arguments[i]);
    if (!within || *within == 0)
      return expects("effect",
                     fmt::format("a duration above 0 in {} after within, for example: effect Q0.0 within 30s", kTimeUnits));
    words.within = *within;
  }
  return {};
}

/// Accumulators, local memory, counters of pulses and special memory are written again and again within a scan.
bool lasts(Area area) { return area != Area::AC && area != Area::L && area != Area::HC && area != Area::SM; }

/// Says what was found, and goes there.
Reply gone_back(Session& session, FoundInPast found) {
  session.said << std::exchange(found.reply.text, {});
  found.reply.moved = found.moment.has_value();  // though it may be but to before something that was done there
  if (found.moment) go_to(session, *found.moment);
  return std::move(found.reply);
}

/// Why the memory is as it is that was not as expected here; nothing if no expectation has failed where it stands.
std::optional<Reply> why_failed(Session& session) {
  const Session::FailedExpectation& failed = session.failed;
  if (failed.memory.empty() || failed.station != session.focus() || failed.moment != session.history.now()) return {};
  Reply all{.json = {{"text", ""}, {"failed", Json::array()}}};
  for (const MemoryRange& range : failed.memory) {
    Reply one = cause_of(session, range, named(session.program(), range));
    all.text += one.text;
    all.json["failed"].push_back(std::move(one.json));
    all.interrupted |= one.interrupted;
  }
  all.json["text"] = all.text;
  return all;
}

}  // namespace

Reply who(Session& session, const Words& arguments) { return writer_of(session, arguments, "who").reply; }

Reply back_to_write(Session& session, const Words& arguments) {
  return gone_back(session, writer_of(session, arguments, "rwho"));
}

Reply effect(Session& session, const Words& arguments) {
  EffectWords words;
  if (const std::string why = take_effect_words(session, arguments, words); !why.empty()) return wrong(why);
  const auto place = one_range(session, words.address, "effect");
  if (!place) return wrong(place.why());
  if (!lasts(place->range.area))
    return wrong(
        fmt::format("effect: {} holds values for a moment only; ask about I, Q, M, S, V, T, C, AI or AQ", place->name));
  const History::Place here = session.history.here();
  if (words.at && !go_to_parsed(session.history, *words.at)) return interrupted(session);
  Reply reply = effect_of(session, place->range, named(session.program(), place->range), words.within);
  session.history.return_to(here);
  return reply;
}

Reply why(Session& session, const Words& arguments) {
  if (arguments.empty()) {
    auto failed = why_failed(session);
    return failed ? std::move(*failed) : last_decider(session).reply;
  }
  if (stl::lower_case(arguments[0]) == "not") return why_not(session, {arguments.begin() + 1, arguments.end()});
  if (stl::lower_case(arguments[0]) == "latency" && arguments.size() == 1) return why_latency(session);
  const auto place = one_range(session, arguments, "why");
  return place ? cause_of(session, place->range, named(session.program(), place->range)) : wrong(place.why());
}

Reply back_to_decision(Session& session, const Words&) {
  FoundInPast found = last_decider(session);
  if (found.reply.json.contains("whyNoMoment"))
    found.reply.text += fmt::format("rwhy goes nowhere: {}\n", found.reply.json["whyNoMoment"].get<std::string>());
  return gone_back(session, std::move(found));
}

Reply history(Session& session, const Words& arguments) {
  const auto count = arguments.empty() ? kUsualInstructions : parse_count(arguments);
  if (!count || *count > kMostInstructions)
    return wrong(
        expects("history", fmt::format("how many instructions, up to {}, for example: history 30", kMostInstructions)));
  const auto found = last_instructions(session.history, session.focus(), *count, session.setup.stop_request);
  if (!found) return interrupted(session);
  Reply reply{.json = {{"instructions", Json::array()}}};
  for (const Execution& one : *found) {
    reply.text += fmt::format("{}  {:<7} {}\n", clock_text(one.record.at), session.listing().routine_of(one.record.op),
                              execution_text(one, session.program()));
    reply.json["instructions"].push_back(execution_json(session, one));
  }
  return reply;
}

Reply timeline(Session& session, const Words& arguments) {
  serial::Exchange exchange =
      session.simulation().has_master() ? session.simulation().master().exchange() : serial::Exchange{};
  if (arguments.empty() && exchange.request.empty())
    return wrong(expects("timeline", "a duration before the first 'send', for example: timeline 50ms"));
  if (!arguments.empty()) {
    const auto before = parse_duration(joined(arguments));
    if (!before || *before == 0)
      return wrong(expects("timeline", fmt::format("a duration above 0 in {}, for example: timeline 50ms", kTimeUnits)));
    const Time now = session.history.now().time;
    exchange.request_start = now - std::min(now, *before);
  }
  return timeline_since(session, exchange.request_start, exchange);
}

}  // namespace s7200::tools::commands
