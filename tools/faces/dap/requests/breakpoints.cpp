// Where to stop.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <utility>

#include "interpreter/base/file_path.hpp"
#include "interpreter/base/result.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/program/ladder/networks.hpp"
#include "interpreter/stl/printer.hpp"
#include "interpreter/trace/text/statement_text.hpp"
#include "tools/faces/dap/addresses.hpp"
#include "tools/faces/dap/exception_filters.hpp"
#include "tools/faces/dap/requests.hpp"
#include "tools/faces/dap/wire/conversation.hpp"
#include "tools/session/stops/stop_words.hpp"
#include "tools/session/words/words.hpp"
#include "tools/views/text_frame.hpp"

namespace s7200::tools::dap {
namespace {

using On = StopPoint::On;
using MakeStops = std::function<std::vector<StopPoint>(const Json& wanted, Json& answer)>;
using StopOfStation = std::function<Result<StopPoint>()>;

/// `5`, `>= 5`, `> 4`: the first hit that stops.
std::uint64_t first_hit(const std::string& text) {
  std::string_view number = stl::trim(text);
  const bool above = number.starts_with('>') && !number.starts_with(">=");
  number.remove_prefix(number.starts_with(">=") ? 2 : above ? 1 : 0);
  const auto hits = parse_decimal<std::uint64_t>(stl::trim(number));
  const std::uint64_t first = hits ? *hits + (above ? 1 : 0) : 0;
  if (first == 0)
    throw Refused(fmt::format("'{}' is not a number of hits; write for example 5 or > 4", stl::shortened(text)));
  return first;
}

/// `always`, `always if VW2 > 8`: with or without power flow. What is left of the condition.
bool take_always(std::string& condition) {
  const std::string_view text = stl::trim(condition);
  if (stl::lower_case(text.substr(0, text.find(' '))) != kAlways.word) return false;
  std::string_view rest = stl::trim(text.substr(kAlways.word.size()));
  if (stl::lower_case(rest).starts_with("if ")) rest = stl::trim(rest.substr(3));
  condition = std::string(rest);
  return true;
}

bool is_wanted(const Json& wanted, const char* key) { return !text_at(wanted, key, "").empty(); }

StopPoint stop_at(Conversation& talk, std::uint32_t op) {
  return {.station = talk.looks_at(),
          .on = On::Place,
          .op = op,
          .name = fmt::format("{} {}", talk.listing().routine_of(op), stl::printable(line_of(op, talk.cpu().program()))),
          .needs_power = true};
}

StopPoint with_conditions(Conversation& talk, StopPoint stop, const Json& wanted) {
  const Program& program = talk.cpu().program();
  if (is_wanted(wanted, "condition")) {
    auto condition = text_at(wanted, "condition");
    if (take_always(condition)) {
      if (const std::string why = refused_option(kAlways, stop); !why.empty()) throw Refused(why);
      stop.needs_power = false;
    }
    if (!condition.empty()) {
      const auto expression = Expression::parse(condition, program);
      if (!expression) throw Refused(expression.why());
      stop.condition = *expression;
    }
  }
  if (is_wanted(wanted, "hitCondition")) stop.from_hit = first_hit(text_at(wanted, "hitCondition"));
  if (is_wanted(wanted, "logMessage")) {
    stop.log = text_at(wanted, "logMessage");
    if (const auto done = check_message(stop.log, program); !done) throw Refused(done.why());
  }
  return stop;
}

void take_away(Conversation& talk, int number) {
  talk.placed.erase(number);
  talk.session->stepper.remove(number);
}

/// Replaces those of a kind and group. One that was wanted before in the same way stays, with its hits.
Json place(Conversation& talk, StopKind kind, const std::string& group, const Json& wanted, const MakeStops& make) {
  std::map<int, Placed> before;
  for (const auto& [number, placed] : talk.placed)
    if (placed.kind == kind && placed.group == group) before.emplace(number, placed);
  Json answers = Json::array();
  for (const Json& one : wanted) {
    const auto same = std::ranges::find_if(before, [&](const auto& entry) { return entry.second.wanted == one; });
    if (same != before.end()) {
      answers.push_back(same->second.answer);
      before.erase(same);
      continue;
    }
    const int number = talk.session->next_number++;
    Json answer{{"id", number}, {"verified", true}};
    const auto refuse = [&answer](const std::string& why) {
      answer.update({{"verified", false}, {"message", why}, {"reason", "failed"}});
    };
    try {
      for (StopPoint& stop : make(one, answer)) {
        stop.number = number;
        if (stop.range)
          stop.value = stop.range->bytes_in(talk.debuggee->history().station(stop.station).cpu().state().image);
        if (!talk.begun.no_debug) talk.session->stepper.add(std::move(stop));
      }
    } catch (const Refused& refused) {
      refuse(refused.what());
    } catch (const WrongValue& wrong) {
      refuse(wrong.what());
    }
    talk.placed[number] = {kind, group, one, answer};
    answers.push_back(std::move(answer));
  }
  for (const auto& [number, placed] : before) take_away(talk, number);
  return {{"breakpoints", std::move(answers)}};
}

/// Of the stations at which `find` finds one; the answer says where the first is.
std::vector<StopPoint> at_all_stations(Conversation& talk, const Json& wanted, Json& answer, const StopOfStation& find) {
  std::vector<StopPoint> stops;
  std::string why_none;
  for (std::size_t station = 0; station < talk.stations(); ++station) {
    const LookAt look(talk, station);
    auto stop = find();
    if (!stop && why_none.empty()) why_none = stop.why();
    if (!stop) continue;
    stop->station = station;
    if (stop->on == On::Place && stops.empty()) {
      answer.update(talk.client_place(stop->op));
      answer["instructionReference"] = at_station(instruction_reference(stop->op), station);
    }
    stops.push_back(with_conditions(talk, std::move(*stop), wanted));
  }
  if (stops.empty()) throw Refused(why_none);
  return stops;
}

std::vector<StopPoint> line_stops(Conversation& talk, const std::string& path, const Json& wanted, Json& answer) {
  const auto wanted_line = talk.client_line_in(wanted);
  const LookAt look(talk, talk.station_with(path));
  const auto lines = talk.sources().lines_of(path);
  if (!lines) throw Refused(fmt::format("{} is not a file of this program", path));
  if (talk.line_of_client(wanted_line) > *lines)
    throw Refused(fmt::format("{} has no line {}; its last one is {}", file_path(path).filename().string(), wanted_line,
                              talk.client_line(*lines)));
  return at_all_stations(talk, wanted, answer, [&]() -> Result<StopPoint> {
    const auto line = talk.sources().line_in(path, talk.line_of_client(wanted_line));
    const auto op = line ? talk.listing().op_from_line(*line) : std::nullopt;
    const stl::Source& source = talk.cpu().program().source;
    const auto file_of = [&](std::uint32_t of_program) { return &stl::in_file(source, of_program).file; };
    if (line && (!op || file_of(talk.listing().line_of(*op)) != file_of(*line)))
      return trouble("{} has no instruction in line {} or after it", file_path(path).filename().string(), wanted_line);
    if (!op) return std::nullopt;
    if (talk.listing().line_of(*op) != *line)
      answer["message"] = fmt::format("line {} has no instruction; this is the next one", wanted_line);
    return stop_at(talk, *op);
  });
}

Json set_breakpoints(Conversation& talk, const Json& arguments) {
  const std::string path = talk.source_path(arguments);
  return place(talk, StopKind::Line, path, list_at(arguments, "breakpoints"),
               [&](const Json& wanted, Json& answer) { return line_stops(talk, path, wanted, answer); });
}

/// `SBR 51`, `INT 123`, `NETWORK 4`, `event 8 occurs`, `received` …, or what causes an event: `port 0: character received`.
std::vector<StopPoint> function_stops(Conversation& talk, const Json& wanted, Json& answer) {
  const auto name = text_at(wanted, "name");
  std::vector<std::string> words = stl::split_words(name);
  if (words.empty()) throw Refused("the name is empty; write for example SBR 51, INT 123, event 8 or received");
  for (const InterruptEvent& event : all_events())
    if (stl::lower_case(event.cause) == stl::lower_case(stl::trim(name)))
      words = {"event", std::to_string(event.number), "served"};
  return at_all_stations(talk, wanted, answer, [&] {
    const bool is_main = stl::lower_case(name) == "main";
    std::string note;
    auto stop = find_stop(is_main ? std::vector{std::to_string(talk.listing().line_of(0))} : words, talk.cpu().program(),
                          talk.listing(), note);
    if (stop) stop->name = name;
    return stop;
  });
}

Json set_function_breakpoints(Conversation& talk, const Json& arguments) {
  return place(talk, StopKind::Function, "", required_list(arguments, "breakpoints"),
               [&](const Json& wanted, Json& answer) { return function_stops(talk, wanted, answer); });
}

Json set_instruction_breakpoints(Conversation& talk, const Json& arguments) {
  return place(talk, StopKind::Instruction, "", required_list(arguments, "breakpoints"),
               [&](const Json& wanted, Json& answer) {
                 const auto reference = text_at(wanted, "instructionReference");
                 const auto of = find_station(reference, talk.stations());
                 const LookAt look(talk, of ? of->station : talk.looks_at());
                 const auto number = of ? find_instruction_number(of->reference) : std::nullopt;
                 const std::int64_t op = number.value_or(-1) + amount_in(wanted, "offset", 0);
                 if (!number || op < 0 || op >= static_cast<std::int64_t>(talk.cpu().program().ops.size()))
                   throw Refused(fmt::format("{} is not an instruction of this program", stl::shortened(reference)));
                 StopPoint stop = stop_at(talk, static_cast<std::uint32_t>(op));
                 stop.needs_power = false;
                 if (depends_on_power_flow(talk.cpu().program().ops[stop.op]))
                   answer["message"] = "stops without power flow, too";
                 answer.update(talk.client_place(stop.op));
                 answer["instructionReference"] = at_station(instruction_reference(op), talk.looks_at());
                 return std::vector{with_conditions(talk, std::move(stop), wanted)};
               });
}

Json breakpoint_locations(Conversation& talk, const Json& arguments) {
  const std::string path = talk.source_path(arguments);
  const LookAt look(talk, talk.station_with(path));
  const auto first = talk.client_line_in(arguments);
  const auto last = std::min(member(arguments, "endLine") ? talk.client_line_in(arguments, "endLine") : first,
                             talk.client_line(talk.listing().last_line()));
  Json locations = Json::array();
  for (std::uint32_t line = first; line <= last; ++line) {
    const auto of_program = talk.sources().line_in(path, talk.line_of_client(line));
    const auto op = of_program ? talk.listing().op_from_line(*of_program) : std::nullopt;
    if (op && talk.listing().line_of(*op) == of_program) locations.push_back({{"line", line}});
  }
  return {{"breakpoints", locations}};
}

Json data_breakpoint_info(Conversation& talk, const Json& arguments) {
  const auto name = text_at(arguments, "name");
  std::string text = name.substr(0, name.find(' ', name.starts_with('"') ? quotation_length(name) : 0));
  if (truth_at(arguments, "asAddress", false)) {
    const auto place = find_memory(text, talk.cpu().program());
    if (!place) throw Refused(fmt::format("'{}' is not an address of memory", stl::shortened(text)));
    for (const AreaInfo& area : all_areas())
      if (area.base == place->begin && area.element == 0) text = fmt::format("{}B{}", area.name, place->at - place->begin);
  }
  const auto where = parse_place(text, talk.cpu().program());
  auto range = where ? range_now(*where, talk.cpu()) : std::nullopt;
  if (!range) return {{"dataId", nullptr}, {"description", where ? text + " points nowhere" : where.why()}};
  if (const auto bytes = number_at<std::uint32_t>(arguments, "bytes", kWhole<std::uint32_t>, 0); bytes > 0) {
    text = fmt::format("{}B{}:{}", info(range->area).name, range->number, bytes);
    const auto bytes_there = parse_range(text, talk.cpu().program());
    if (!bytes_there) return {{"dataId", nullptr}, {"description", bytes_there.why()}};
    range = *bytes_there;
  } else if (where->pointer || text.starts_with('"')) {
    text = range->count > 1 ? fmt::format("{}:{}", range->name_of(0), range->count) : range->name_of(0);
  }
  const bool every_write = stl::lower_case(name).ends_with(" write");
  const std::string id = at_station(text, talk.looks_at());
  return {{"dataId", every_write ? id + " write" : id},
          {"description", every_write ? text + ", each write" : text},
          {"accessTypes", Json::array({"read", "write", "readWrite"})},
          {"canPersist", true}};
}

/// `write` stops when the value changes, whoever changes it; with `write` in the name at each write of an instruction.
std::vector<StopPoint> data_stops(Conversation& talk, const Json& wanted) {
  const auto id = text_at(wanted, "dataId");
  const auto of = find_station(id.substr(0, id.find(' ')), talk.stations());
  if (!of) throw Refused(fmt::format("'{}' is of no station of this system", stl::shortened(id)));
  const LookAt look(talk, of->station);
  const std::string &name = of->reference, access = text_at(wanted, "accessType", "write");
  const auto range = parse_range(name, talk.cpu().program());
  if (!range) throw Refused(range.why());
  if (access != "read" && access != "write" && access != "readWrite")
    throw Refused(fmt::format("accessType: '{}' is not read, write or readWrite", stl::shortened(access)));
  const On written = stl::lower_case(id).ends_with(" write") ? On::Write : On::Change;
  const On on = access == "read" ? On::Read : access == "write" ? written : On::ReadWrite;
  return {with_conditions(talk, {.station = of->station, .on = on, .range = *range, .name = name}, wanted)};
}

Json set_data_breakpoints(Conversation& talk, const Json& arguments) {
  return place(talk, StopKind::Data, "", required_list(arguments, "breakpoints"),
               [&](const Json& wanted, Json&) { return data_stops(talk, wanted); });
}

std::vector<StopPoint> exception_stops(const Json& wanted) {
  const std::string id = text_at(wanted, "filterId", "");
  const auto filter = std::ranges::find(kExceptionFilters, id, &ExceptionFilter::id);
  if (filter == std::end(kExceptionFilters))
    throw Refused(fmt::format("there is no exception filter '{}'", stl::shortened(id)));
  if (!filter->on) return {};
  std::string codes = filter->codes.empty() ? "" : text_at(wanted, "condition", "");
  std::ranges::replace(codes, ',', ' ');
  std::vector<StopPoint> stops;
  for (const std::string& text : stl::split_words(codes)) {
    const auto code = error_code_of(text);
    if (!code) throw Refused(code.why());
    stops.push_back({.on = *filter->on, .code = *code, .name = fmt::format("{} {}", filter->name, text)});
  }
  if (stops.empty()) stops.push_back({.on = *filter->on, .name = filter->name});
  return stops;
}

std::size_t first_on(Conversation& talk, std::size_t line) {
  const PlcRequests& requests = talk.debuggee->history().requests();
  for (std::size_t station = 0; station < talk.stations(); ++station)
    for (std::uint8_t port = 0; port < talk.program_of(station).model->ports; ++port)
      if (requests.line_of(station, port) == line) return station;
  return 0;
}

/// At each PLC; on each line once, for the first PLC on it.
std::vector<StopPoint> at_each_station(Conversation& talk, StopPoint stop) {
  const bool of_lines = stop.is_of_requests();
  const std::size_t count = of_lines ? talk.debuggee->history().requests().lines().size() : talk.stations();
  std::vector<StopPoint> stops;
  for (std::size_t number = 0; number < count; ++number) {
    stop.station = of_lines ? first_on(talk, number) : number;
    if (of_lines) stop.line = number;
    stops.push_back(stop);
  }
  return stops;
}

Json set_exception_breakpoints(Conversation& talk, const Json& arguments) {
  Json wanted = list_at(arguments, "filterOptions");
  for (const Json& filter : list_at(arguments, "filters")) wanted.push_back({{"filterId", filter}});
  return place(talk, StopKind::Exception, "", wanted, [&](const Json& one, Json&) {
    std::vector<StopPoint> stops;
    for (const StopPoint& stop : exception_stops(one))
      std::ranges::copy(at_each_station(talk, stop), std::back_inserter(stops));
    return stops;
  });
}

Json exception_info(Conversation& talk, const Json&) {
  const auto exception = talk.exceptions.find(talk.looks_at());
  if (exception == talk.exceptions.end())
    throw Refused(talk.said_of(talk.looks_at()) + "it has not stopped for an exception");
  return exception->second;
}

}  // namespace

StopKind kind_of(const Conversation& talk, int number) {
  const auto placed = talk.placed.find(number);
  return placed == talk.placed.end() ? StopKind::Function : placed->second.kind;
}

std::vector<Request> breakpoints_requests() {
  return {{"setBreakpoints", set_breakpoints},
          {"setFunctionBreakpoints", set_function_breakpoints},
          {"setDataBreakpoints", set_data_breakpoints},
          {"setInstructionBreakpoints", set_instruction_breakpoints},
          {"setExceptionBreakpoints", set_exception_breakpoints},
          {"breakpointLocations", breakpoint_locations},
          {"dataBreakpointInfo", data_breakpoint_info},
          {"exceptionInfo", exception_info}};
}

}  // namespace s7200::tools::dap
