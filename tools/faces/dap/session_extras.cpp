// Requests of our own: what the protocol has none for. The console has words for some of them.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <sstream>

#include "interpreter/base/numbers.hpp"
#include "interpreter/base/text.hpp"
#include "interpreter/trace/text_trace.hpp"
#include "tools/faces/dap/session.hpp"
#include "tools/session/causes/last_decision.hpp"
#include "tools/session/causes/two_masters.hpp"
#include "tools/session/causes/writer.hpp"
#include "tools/session/commands/fault_words.hpp"
#include "tools/session/commands/force_words.hpp"
#include "tools/session/commands/frame_words.hpp"
#include "tools/session/commands/line_words.hpp"
#include "tools/session/commands/mode_words.hpp"
#include "tools/session/observers/last_executions.hpp"
#include "tools/session/observers/last_instructions.hpp"
#include "tools/session/observers/timeline_of_past.hpp"
#include "tools/session/stops/words.hpp"
#include "tools/views/execution_text.hpp"
#include "tools/views/machine_text.hpp"
#include "tools/views/timeline.hpp"

namespace s7200::tools::dap {
namespace {

/// A text with blanks between its words, or a list of them; `VW10 = 5` is one.
std::vector<std::string> words_in(const Json& arguments, const char* key) {
  std::vector<std::string> words;
  for (const std::string& text : texts_at(arguments, key)) {
    std::istringstream parts(text);
    words.insert(words.end(), std::istream_iterator<std::string>(parts), {});
  }
  return assignments_of(words);
}

}  // namespace

serial::Frame Session::parsed_frame(const std::string& text) const {
  std::string why;
  const auto frame = parse_frame(text, station_, why);
  if (!frame) throw Refused(fmt::format("'{}': {}", stl::shortened(text), why));
  return *frame;
}

Json Session::send_frame(const Json& arguments) {
  std::string why;
  if (stl::lower_case(text_at(arguments, "frame")) == "cancel") {
    const auto cancel = cancel_of(simulation(), why);
    if (!cancel) throw Refused(why);
    print(cancelled_text(*cancel, simulation()));
    act(*cancel);
    return {{"frame", serial::to_hex(simulation().master().exchange().request)}};
  }
  const serial::Frame frame = parsed_frame(text_at(arguments, "frame"));
  const auto send = send_of(frame, simulation(), master(), why);
  if (!send) throw Refused(why);
  act(*send);
  print(sent_text(*send, simulation()) + other_master_text(debuggee_->history(), looks_at()) + without_power());
  return {{"frame", serial::to_hex(frame)}};
}

Json Session::inject_fault(const Json& arguments) {
  std::string why;
  const auto inject = fault_of(text_at(arguments, "fault"), debuggee_->history(), looks_at(), why);
  if (!inject) throw Refused(why);
  act(*inject);
  return {{"text", fault_text(*inject)}};
}

// --- mode ---

void Session::change_mode(const std::string& word) {
  std::string why = without_power();
  if (!why.empty()) throw Refused(why);
  const auto set = mode_of(word, simulation(), why);
  if (!set) throw Refused(why);
  act(*set);
}

void Session::switch_power(const std::string& word) {
  const std::string name = stl::lower_case(word);
  if (name != "off" && name != "on") throw Refused("power expects off or on");
  const bool on = name == "on";
  if (simulation().plc().powered() == on)
    throw Refused(fmt::format("{}the PLC is {} power already", said_of(looks_at()), on ? "with" : "without"));
  act(SetPower{on});
}

// --- force ---

Json Session::forced() const {
  Json all = Json::array();
  std::string text;
  for (const Forced& one : forced_in(cpu())) {
    all.push_back({{"name", one.place.name_of(0)}, {"value", one.value}});
    text += fmt::format("{:<8} {}\n", one.place.name_of(0), one.value);
  }
  return {{"forced", all}, {"text", text.empty() ? "nothing is forced" : text}};
}

Json Session::force(const Json& arguments) {
  const auto values = words_in(arguments, "values");
  std::string why;
  auto force = force_of(values, cpu(), why);
  if (!force) throw Refused(why);
  if (!values.empty()) act(std::move(*force));
  return forced();
}

Json Session::unforce(const Json& arguments) {
  const auto places = words_in(arguments, "places");
  if (places.empty()) throw Refused("unforce: 'places' is missing: addresses that are forced, or all");
  std::string why;
  auto unforce = unforce_of(places, cpu(), why);
  if (!unforce) throw Refused(why);
  if (!unforce->places.empty()) act(std::move(*unforce));
  return forced();
}

// --- timeline ---

/// Of the last exchange, unless `from` names an earlier moment.
Json Session::timeline(const Json& arguments) {
  const serial::Exchange exchange = simulation().has_master() ? simulation().master().exchange() : serial::Exchange{};
  Time from = exchange.request_start;
  if (member(arguments, "from")) {
    const auto time = parse_duration(text_at(arguments, "from"));
    if (!time) throw Refused("from must be a time, such as 15.193ms");
    from = *time;
  }
  const auto report = timeline_of_past(debuggee_->history(), looks_at(), program(), from, settings_.stop_request);
  if (!report) refuse_interrupted();
  return {{"text", to_text(*report, exchange, false)}, {"timeline", to_json(*report, exchange)}};
}

// --- who ---

/// Of an address, or of `event 8`.
Session::Found Session::find_writer(const std::string& expression) {
  History& history = debuggee_->history();
  const auto words = stl::split_words(expression);
  const bool of_event = !words.empty() && stl::lower_case(words[0]) == "event";
  const auto event = event_of(words);
  if (of_event && !event) throw Refused(expects_event("", words));
  const WriterSearch search =
      event ? tools::find_writer(history, looks_at(), listing(), *event, settings_.stop_request)
            : tools::find_writer(history, looks_at(), listing(), range_for(expression), expression, settings_.stop_request);
  if (search.interrupted) refuse_interrupted();
  if (!search.writer) return {std::nullopt, {{"text", search.none}}};
  Json body{{"text", search.writer->text}};
  if (const auto& by = search.writer->by) body.update(named(*by));
  return {search.writer->moment, body};
}

/// An instruction that was executed, and where it is.
Json Session::named(const InstructionRecord& record) const {
  Json body{{"instruction", execution_text(record, cpu().program())}, {"routine", listing().routine_of(record.op)}};
  body.update(client_place(record.op));
  return body;
}

Json Session::last_write(const Json& arguments) { return find_writer(text_at(arguments, "expression")).body; }

Json Session::reverse_to_last_write(const Json& arguments) {
  const Found written = find_writer(text_at(arguments, "expression"));
  if (!written.moment) throw Refused(written.body["text"].get<std::string>());
  after_response([this, written] {
    print(written.body["text"].get<std::string>());
    debuggee_->history().go_to(*written.moment);
    stopped_at("step", "in front of the last write");
  });
  return written.body;
}

// --- why ---

Session::Found Session::find_decision() {
  const DecisionSearch search =
      find_last_decision(debuggee_->history(), looks_at(), stepper_->host_timeout(), settings_.stop_request);
  if (search.interrupted) refuse_interrupted();
  std::string text;
  for (const std::string& line : to_lines(search, listing())) text += (text.empty() ? "" : "\n") + line;
  if (!search.origin()) return {std::nullopt, {{"text", text}}, search.why_no_origin()};
  const LastDecision found = *search.origin();
  Json body{{"text", text}};
  body.update(named(found.by));
  return {found.moment, body};
}

Json Session::last_decision(const Json&) { return find_decision().body; }

Json Session::reverse_to_last_decision(const Json&) {
  const Found found = find_decision();
  if (!found.moment) throw Refused(found.body["text"].get<std::string>() + "\n" + found.why_no_moment);
  after_response([this, found] {
    print(found.body["text"].get<std::string>());
    debuggee_->history().go_to(*found.moment);
    stopped_at("step", "in front of what decided");
  });
  return found.body;
}

Json Session::last_instructions(const Json& arguments) {
  const auto count = number_at<std::int64_t>(arguments, "count", kWhole<std::int64_t>, kUsualInstructions);
  if (count < 1 || count > kMostInstructions)
    throw Refused(fmt::format("count must be a number from 1 to {}", kMostInstructions));
  const auto found =
      tools::last_instructions(debuggee_->history(), looks_at(), static_cast<std::size_t>(count), settings_.stop_request);
  if (!found) refuse_interrupted();
  Json list = Json::array();
  for (const Execution& execution : *found) {
    Json one{{"time", clock_text(execution.record.at)},
             {"routine", listing().routine_of(execution.record.op)},
             {"text", execution_text(execution, cpu().program())}};
    one.update(client_place(execution.record.op));
    list.push_back(std::move(one));
  }
  return {{"instructions", list}};
}

/// What each instruction of some lines did when it was last executed.
Json Session::stl_status(const Json& arguments) {
  const std::string path = source_path(arguments);
  const LookAt look(*this, station_with(path));
  const auto first_line = sources().line_in(path, line_of_client(client_line_in(arguments)));
  const auto last_line = sources().line_in(path, line_of_client(client_line_in(arguments, "endLine")));
  const Program& program = cpu().program();
  const auto first = first_line ? listing().op_from_line(*first_line) : std::nullopt;
  Json lines = Json::array();
  if (first) {
    auto end = static_cast<std::uint32_t>(program.ops.size());
    while (last_line && end > *first && listing().line_of(end - 1) > *last_line) --end;
    const LastExecutions last =
        tools::last_executions(debuggee_->history(), looks_at(), *first, end, kLookedAt, settings_.stop_request);
    for (const auto& [op, execution] : last.of) {
      const std::string text = describe(execution, program);
      const std::size_t values = text.find("S0=");
      lines.push_back({{"line", client_place(op)["line"]},
                       {"powerFlow", execution.record.powered},
                       {"text", values == std::string::npos ? text : text.substr(values)}});
    }
  }
  return {{"lines", lines}};
}

}  // namespace s7200::tools::dap
