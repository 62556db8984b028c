// What there is to see while it stands still.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "interpreter/base/text/text.hpp"
#include "interpreter/program/loading/stand_ins.hpp"
#include "interpreter/stl/printer.hpp"
#include "tools/faces/dap/addresses.hpp"
#include "tools/faces/dap/requests.hpp"
#include "tools/faces/dap/requests/variables.hpp"
#include "tools/faces/dap/wire/conversation.hpp"
#include "tools/session/commands/answers/cause_reports.hpp"
#include "tools/session/commands/rows/command_table.hpp"
#include "tools/session/commands/rows/completion.hpp"
#include "tools/session/observers/call_stack.hpp"
#include "tools/session/stops/stop_words.hpp"
#include "tools/session/words/address_words.hpp"
#include "tools/session/words/bad_pointers.hpp"
#include "tools/views/state/machine_text.hpp"
#include "tools/views/state/memory.hpp"

namespace s7200::tools::dap {
namespace {

std::int64_t container_at(std::size_t station, Container container) {
  return container == kNoParts ? 0 : static_cast<std::int64_t>(station) * kContainersOfAStation + container;
}

Json to_json(const Variable& variable, std::size_t station) {
  Json json{
      {"name", variable.name}, {"value", variable.value}, {"variablesReference", container_at(station, variable.parts)}};
  if (!variable.type.empty()) json["type"] = variable.type;
  if (!variable.expression.empty()) json["evaluateName"] = variable.expression;
  if (!variable.memory.empty()) json["memoryReference"] = at_station(variable.memory, station);
  if (!variable.settable) json["presentationHint"] = {{"attributes", Json::array({"readOnly"})}};
  return json;
}

/// `16#05`, without what stands behind it.
std::string hex_of(const std::string& value) { return value.substr(0, value.find(' ')); }

bool wants_hex(const Json& arguments) { return truth_at(map_at(arguments, "format"), "hex", false); }

/// `modbus_slave.stl!INT 123, line 40`, as much of it as is asked for.
void format_name(Json& frame, const Json& format) {
  auto name = frame["name"].get<std::string>();
  if (truth_at(format, "module", false)) name = frame["source"].value("name", "") + "!" + name;
  if (truth_at(format, "line", false)) name += fmt::format(", line {}", frame["line"].get<int>());
  frame["name"] = name;
}

/// What a byte of UTF-8 counts in UTF-16, in which the protocol counts: the first one of each character stands for it all.
std::size_t units_of(char byte) {
  const auto bits = static_cast<std::uint8_t>(byte);
  return (bits & 0xC0) == 0x80 ? 0 : bits >= 0xF0 ? 2 : 1;
}

std::size_t units_of(std::string_view text) {
  std::size_t units = 0;
  for (const char byte : text) units += units_of(byte);
  return units;
}

/// The beginning of a text that is so long.
std::string first_units(const std::string& text, std::size_t units) {
  std::size_t end = 0;
  for (; end < text.size() && units_of(text[end]) <= units; ++end) units -= units_of(text[end]);
  return text.substr(0, end);
}

/// `  Freeport, 9600 baud`: of special memory, as `print` says it.
std::string words_of(const Cpu& cpu, const MemoryRange& range) {
  std::string words;
  for (const std::string& line : stl::split_lines(special_text(cpu, range)))
    words += fmt::format("{}{}", words.empty() ? "  " : "; ", stl::trim(line));
  return words;
}

Json threads(Conversation& talk, const Json&) {
  Json threads = Json::array();
  if (!talk.debuggee) threads.push_back({{"id", 1}, {"name", "CPU"}});
  for (std::size_t station = 0; talk.debuggee && station < talk.stations(); ++station) {
    const std::string alone = fmt::format("CPU {}", talk.program_of(station).model->name);
    threads.push_back(
        {{"id", station + 1}, {"name", talk.session->is_system() ? talk.session->setup.stations[station].name : alone}});
  }
  return {{"threads", threads}};
}

Json stack_frame(Conversation& talk, std::uint32_t number, std::uint32_t op, const std::string& name) {
  Json frame{{"id", static_cast<std::int64_t>(talk.looks_at()) * kFramesOfAStation + number + 1}, {"name", name}};
  frame.update(talk.client_place(op));
  frame["instructionPointerReference"] = at_station(instruction_reference(op), talk.looks_at());
  return frame;
}

Json stack_trace(Conversation& talk, const Json& arguments) {
  const State& state = talk.cpu().state();
  Json frames = Json::array();
  const auto add = [&](std::uint32_t op, const std::string& name) {
    frames.push_back(stack_frame(talk, static_cast<std::uint32_t>(frames.size()), op, name));
  };
  const bool powered = talk.simulation().plc().powered();
  for (const OpenRoutine& open : powered ? open_routines(state) : std::vector<OpenRoutine>{}) {
    const std::string& routine = talk.listing().routine_of(open.op);
    add(open.op, open.event ? fmt::format("{} for {}", routine, event_text(*open.event)) : routine);
  }
  if (frames.empty())
    add(state.fatal_code && state.fatal_op != kNoRoutine ? state.fatal_op : 0, powered ? "STOP" : "without power");
  const auto total = frames.size();
  const auto start = std::min(amount_from_0(arguments, "startFrame"), total);
  const auto levels = amount_from_0(arguments, "levels");
  const auto end = levels == 0 ? total : std::min(total, start + levels);
  Json shown = Json::array();
  for (std::size_t i = start; i < end; ++i) format_name(shown.emplace_back(frames[i]), map_at(arguments, "format"));
  return {{"stackFrames", shown}, {"totalFrames", total}};
}

Json scopes(Conversation& talk, const Json& arguments) {
  const auto frame = number_at<std::uint32_t>(arguments, "frameId");
  if (frame > std::max<std::size_t>(open_routines(talk.cpu().state()).size(), 1))
    throw Refused(fmt::format("there is no frame {}", frame));
  Json scopes = Json::array();
  for (const Scope& scope : scopes_of(talk.simulation(), frame == 0 ? 0 : frame - 1)) {
    Json json{
        {"name", scope.name}, {"variablesReference", container_at(talk.looks_at(), scope.variables)}, {"expensive", false}};
    if (scope.registers) json["presentationHint"] = "registers";
    if (!scope.memory.empty()) json["memoryReference"] = at_station(scope.memory, talk.looks_at());
    scopes.push_back(std::move(json));
  }
  return {{"scopes", scopes}};
}

Json variables(Conversation& talk, const Json& arguments) {
  const auto container = number_at<Container>(arguments, "variablesReference");
  const auto all = variables_of(talk.simulation(), talk.debuggee->history(), container);
  const auto start = std::min(amount_from_0(arguments, "start"), all.size());
  const auto count = amount_from_0(arguments, "count");
  const auto end = count == 0 ? all.size() : std::min(all.size(), start + count);
  Json variables = Json::array();
  for (std::size_t i = start; i < end; ++i) {
    variables.push_back(to_json(all[i], talk.looks_at()));
    if (wants_hex(arguments) && !all[i].memory.empty()) variables.back()["value"] = hex_of(all[i].value);
  }
  return {{"variables", variables}};
}

/// Of the stand-ins for libraries, which are no files.
Json source(Conversation&, const Json& arguments) {
  const std::string text = stand_in_text(static_cast<std::size_t>(number_at<std::int64_t>(arguments, "sourceReference")));
  if (text.empty()) throw Refused("sources that have no reference are files: read them by their paths");
  return {{"content", text}, {"mimeType", "text/plain"}};
}

Json loaded_sources(Conversation& talk, const Json&) {
  Json all = Json::array();
  for (const Sources& sources : talk.sources_of)
    for (const Json& source : sources.all())
      if (std::ranges::find(all, source) == all.end()) all.push_back(source);
  return {{"sources", all}};
}

Json evaluated(Conversation& talk, const std::string& expression, bool hex) {
  const auto place = parse_place(expression, talk.cpu().program());
  if (place) {
    const auto range = range_now(*place, talk.cpu());
    if (!range) throw Refused(text_of_bad_pointer(talk, expression, place->range));
    const Variable variable = variable_of(talk.cpu(), *range, expression);
    return {{"result", hex ? hex_of(variable.value) : variable.value + words_of(talk.cpu(), *range)},
            {"type", variable.type},
            {"variablesReference", 0},
            {"memoryReference", at_station(variable.memory, talk.looks_at())}};
  }
  const auto parsed = Expression::parse(expression, talk.cpu().program());
  const bool one_word = expression.find_first_of(" (+-/<>=&") == std::string::npos;
  if (!parsed) throw Refused(one_word ? place.why() : parsed.why());
  const auto value = parsed->value(talk.cpu());
  if (!value) throw Refused("cannot be computed: " + value.why());
  const auto bits = bits_of(*value);
  const std::string text = hex && bits ? fmt::format("16#{:X}", *bits) : number_text(*value);
  return {{"result", text}, {"type", value->real ? "REAL" : "DINT"}, {"variablesReference", 0}};
}

Json evaluate(Conversation& talk, const Json& arguments) {
  const std::string expression(stl::trim(text_at(arguments, "expression")));
  const bool is_typed = text_at(arguments, "context", "") == "repl";
  if (is_typed && is_command(expression, talk.cpu().program())) return console(talk, expression);
  return evaluated(talk, expression, wants_hex(arguments));
}

/// Of a command: what its last word may become.
Json offers_of_command(Conversation& talk, const std::string& before) {
  const Offers offers = tools::completions(*talk.session, before);
  const std::string written = before.substr(before.size() - offers.word);
  const std::size_t start = units_of(before) - units_of(written) + talk.client.column_base;
  Json targets = Json::array();
  for (const std::string& label : offers.candidates)
    targets.push_back({{"label", label}, {"start", start}, {"length", units_of(written)}});
  return {{"targets", targets}};
}

/// What the last word before the cursor may become.
Json completions(Conversation& talk, const Json& arguments) {
  const auto text = text_at(arguments, "text");
  const auto column = number_at<std::uint32_t>(arguments, "column");
  const std::string before = first_units(text, column - std::min(column, talk.client.column_base));
  if (before.find(' ') != std::string::npos && is_command(before, talk.cpu().program()))
    return offers_of_command(talk, before);
  const std::size_t begin = before.find_last_of(" (*=<>+-/") + 1;
  const std::size_t start = units_of(before.substr(0, begin)) + talk.client.column_base;
  const std::string word = stl::upper_case(before.substr(begin));
  std::set<std::string> found;
  const auto offer = [&](std::string_view label) {
    if (stl::upper_case(label).starts_with(word)) found.insert(std::string(label));
  };
  if (begin == 0) std::ranges::for_each(command_names(), offer);
  std::ranges::for_each(area_words(*talk.cpu().program().model), offer);
  std::ranges::for_each(address_words(talk.cpu().program()), offer);
  Json targets = Json::array();
  for (const std::string& label : found) targets.push_back({{"label", label}, {"start", start}, {"length", units_of(word)}});
  return {{"targets", targets}};
}

/// The addresses that pointers lead to now, and how long it takes.
std::string resolved_text(Conversation& talk, std::uint32_t number) {
  const Program& program = talk.cpu().program();
  const Op& op = program.ops[number];
  const stl::Statement& statement = program.statement(number);
  std::string text = stl::to_text(statement), resolved;
  for (std::size_t i = 0; i < std::min<std::size_t>(statement.operands.size(), op.operand.size()); ++i) {
    if (!std::holds_alternative<stl::Indirect>(statement.operands[i].value)) continue;
    const std::string pointer = stl::to_text(statement.operands[i]);
    static constexpr std::string_view kWidths[] = {"", "", ":word", "", ":dword"};
    const auto place = parse_place(pointer + std::string(kWidths[std::min<std::size_t>(op[i].width, 4)]), program);
    const auto range = place ? range_now(*place, talk.cpu()) : std::nullopt;
    resolved += fmt::format("{} = {}, ", pointer, range ? range->name_of(0) : "nowhere");
  }
  const std::string each =
      op.unit_cost == 0 ? "" : fmt::format(" + {} each", format_duration(static_cast<Time>(op.unit_cost)));
  return fmt::format("{:<28} // {}{}{}", text, resolved, format_duration(static_cast<Time>(op.cost)), each);
}

Json disassemble(Conversation& talk, const Json& arguments) {
  const auto reference = text_at(arguments, "memoryReference");
  const auto number = find_instruction_number(reference);
  if (!number) throw Refused(fmt::format("'{}' is not an instruction of this program", stl::shortened(reference)));
  const std::int64_t first = *number + amount_in(arguments, "offset", 0) + amount_in(arguments, "instructionOffset", 0);
  constexpr std::int64_t kMost = 10'000;
  const auto count = std::clamp<std::int64_t>(amount_in(arguments, "instructionCount", 0), 0, kMost);
  const auto size = static_cast<std::int64_t>(talk.cpu().program().ops.size());
  Json instructions = Json::array();
  for (std::int64_t i = first; i < first + count; ++i) {
    Json one{{"address", at_station(instruction_reference(i), talk.looks_at())}};
    if (i < 0 || i >= size) {
      one.update({{"instruction", "-"}, {"presentationHint", "invalid"}});
    } else {
      const auto op = static_cast<std::uint32_t>(i);
      const Json place = talk.client_place(op);
      one["instruction"] = resolved_text(talk, op);
      one["location"] = place["source"];
      one["line"] = place["line"];
      if (op == 0 || talk.listing().routine_of(op) != talk.listing().routine_of(op - 1))
        one["symbol"] = talk.listing().routine_of(op);
    }
    instructions.push_back(std::move(one));
  }
  return {{"instructions", instructions}};
}

}  // namespace

std::string text_of_bad_pointer(Conversation& talk, const std::string& name, const MemoryRange& pointer) {
  const std::string address = pointer.name_of(0);
  std::string text = bad_pointer_text(talk.cpu(), pointer, name, address);
  if (talk.runs()) return text;
  const Reply reply = last_writer(*talk.session, pointer, address).reply;
  return text + "\n" + (reply.interrupted ? std::string("cancelled") : text_in(reply.json, "text"));
}

std::vector<Request> seeing_requests() {
  return {{"threads", threads, Needs::Nothing},
          {"stackTrace", stack_trace},
          {"scopes", scopes},
          {"variables", variables},
          {"loadedSources", loaded_sources},
          {"source", source, Needs::Nothing},
          {"evaluate", evaluate},
          {"completions", completions},
          {"disassemble", disassemble}};
}

}  // namespace s7200::tools::dap
