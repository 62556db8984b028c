// Reading and writing memory, and what the client is told when it changes.
#include "tools/views/state/memory.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/faces/dap/addresses.hpp"
#include "tools/faces/dap/requests.hpp"
#include "tools/faces/dap/requests/variables.hpp"
#include "tools/faces/dap/wire/conversation.hpp"
#include "tools/json/base64.hpp"
#include "tools/session/commands/running.hpp"
#include "tools/session/words/force_words.hpp"

namespace s7200::tools::dap {
namespace {

MemoryPlace memory_at(const Json& arguments, const Program& program) {
  const auto reference = text_at(arguments, "memoryReference");
  const auto place = find_memory(reference, program);
  if (!place)
    throw Refused(fmt::format("'{}' is not memory of this CPU; write for example V, VB100, AC0", stl::shortened(reference)));
  return *place;
}

/// Timers, counters and accumulators are set as a whole: bytes that are not written stay as they are.
std::vector<Assignment> assignments_of(const AreaInfo& area, std::uint32_t first, const std::vector<std::uint8_t>& bytes,
                                       const State& state) {
  const std::uint32_t step = area.step(), end = first + static_cast<std::uint32_t>(bytes.size());
  const Width width = step == 4 ? Width::Double : step == 2 ? Width::Word : Width::Byte;
  std::vector<Assignment> all;
  for (std::uint32_t at = first - (first - area.base) % step; at < end; at += step) {
    std::uint32_t value = 0;
    for (std::uint32_t i = at; i < at + step; ++i)
      value = value << 8 | (i >= first && i < end ? bytes[i - first] : state.image[i]);
    all.push_back({{.area = area.area, .width = width, .number = (at - area.base) / step, .at = at}, value});
  }
  return all;
}

Json read_memory(Conversation& talk, const Json& arguments) {
  const MemoryPlace place = memory_at(arguments, talk.cpu().program());
  const std::vector<std::uint8_t> all = bytes_of(place, talk.cpu().state());
  const std::int64_t area_end = place.begin + static_cast<std::int64_t>(all.size());
  const std::int64_t count = amount_in(arguments, "count", 0);
  if (count < 0) throw Refused(fmt::format("count: {} is less than 0", count));
  const std::int64_t first = place.at + amount_in(arguments, "offset", 0);
  const std::int64_t begin = std::clamp<std::int64_t>(first, place.begin, area_end);
  const std::int64_t end = std::clamp<std::int64_t>(first + count, begin, area_end);
  Json body{{"address", at_station(address_text(begin), talk.looks_at())}};
  if (first + count > end) body["unreadableBytes"] = std::max<std::int64_t>(0, first + count - end);
  if (begin == end) return body;
  body["data"] = to_base64(
      std::span(all).subspan(static_cast<std::size_t>(begin - place.begin), static_cast<std::size_t>(end - begin)));
  // to tell when it changes, an area is looked at as a whole
  ReadArea& area = talk.read.try_emplace({talk.looks_at(), place.begin}, ReadArea{.bytes = all}).first->second;
  area.references.insert(at_station(text_at(arguments, "memoryReference"), talk.looks_at()));
  return body;
}

void write_image(Conversation& talk, const MemoryPlace& place, std::uint32_t first, const std::vector<std::uint8_t>& bytes) {
  const auto area = std::ranges::find(all_areas(), place.begin, &AreaInfo::base);
  SetMemory set{assignments_of(*area, first, bytes, talk.cpu().state())};
  for (const Assignment& assignment : set.assignments)
    if (const std::string refused = not_settable(assignment.place); !refused.empty()) throw Refused(refused);
  act(talk, std::move(set));
}

/// Of the logic stack: a byte is a level.
void write_levels(Conversation& talk, const MemoryPlace& place, std::uint32_t first,
                  const std::vector<std::uint8_t>& bytes) {
  if (place.open != 0) throw Refused("only the logic stack of the routine that runs can be set; the others wait");
  if (!standing_at(talk.cpu().state())) throw Refused("no program runs now whose logic stack could be set");
  std::uint16_t bits = talk.cpu().state().stack.bits();
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (bytes[i] > 1) throw Refused(fmt::format("a level of the logic stack is 0 or 1, not {}", bytes[i]));
    const unsigned level = first - place.begin + static_cast<unsigned>(i);
    bits = static_cast<std::uint16_t>((bits & ~(1u << level)) | static_cast<unsigned>(bytes[i]) << level);
  }
  act(talk, SetStack{LogicStack::from_bits(bits)});
}

Json write_memory(Conversation& talk, const Json& arguments) {
  const MemoryPlace place = memory_at(arguments, talk.cpu().program());
  auto bytes = from_base64(text_at(arguments, "data"));
  if (!bytes) throw Refused("data is not base64");
  if (place.owner == Owner::SavedAccumulators)
    throw Refused("the accumulators that an interrupted routine will find again cannot be set");
  const std::int64_t first = place.at + amount_in(arguments, "offset", 0);
  const std::int64_t room = first < place.begin ? 0 : std::max<std::int64_t>(0, place.end - first);
  if (static_cast<std::int64_t>(bytes->size()) > room) {
    if (!truth_at(arguments, "allowPartial", false))
      throw Refused(fmt::format("{} bytes from there run past the end of the area", bytes->size()));
    bytes->resize(static_cast<std::size_t>(room));
  }
  if (place.owner == Owner::LogicStack)
    write_levels(talk, place, static_cast<std::uint32_t>(first), *bytes);
  else
    write_image(talk, place, static_cast<std::uint32_t>(first), *bytes);
  return {{"bytesWritten", bytes->size()}};
}

MemoryRange range_for(Conversation& talk, const std::string& expression) {
  const auto place = parse_place(expression, talk.cpu().program());
  if (!place) throw Refused(place.why());
  const auto range = range_now(*place, talk.cpu());
  if (!range) throw Refused(fmt::format("{} points nowhere", expression));
  return *range;
}

Json assign(Conversation& talk, const std::string& expression, const std::string& value) {
  const MemoryRange range = range_for(talk, expression);
  const auto assignment = parse_value(range, value);
  if (range.count != 1) throw Refused(fmt::format("'{}' is not one value but {}", stl::shortened(expression), range.count));
  if (!assignment)
    throw Refused(
        fmt::format("'{}' is not a value that fits {}: {}", stl::shortened(value), expression, values_text(range)));
  if (const std::string refused = not_settable(range); !refused.empty()) throw Refused(refused);
  act(talk, SetMemory{{*assignment}});
  const Variable variable = variable_of(talk.cpu(), range, expression);
  Json body{
      {"value", variable.value}, {"type", variable.type}, {"memoryReference", at_station(variable.memory, talk.looks_at())}};
  if (range.area == Area::I && standing_at(talk.cpu().state()))
    talk.print("the input points are set; the program finds them in I when the next scan reads its inputs");
  return body;
}

Json set_level(Conversation& talk, const Variable& level, const std::string& value) {
  const auto bit = parse_decimal<std::uint8_t>(stl::trim(value));
  if (!bit || *bit > 1) throw Refused(fmt::format("'{}' is not a level of the logic stack: 0 or 1", stl::shortened(value)));
  const auto place = find_memory(level.memory, talk.cpu().program());
  write_levels(talk, *place, place->at, {*bit});
  return {
      {"value", std::to_string(*bit)}, {"type", level.type}, {"memoryReference", at_station(level.memory, talk.looks_at())}};
}

Json set_variable(Conversation& talk, const Json& arguments) {
  const auto name = text_at(arguments, "name");
  const auto container = number_at<Container>(arguments, "variablesReference");
  for (const Variable& variable : variables_of(talk.simulation(), talk.debuggee->history(), container))
    if (variable.name == name && variable.settable) {
      const auto value = text_at(arguments, "value");
      return variable.expression.empty() ? set_level(talk, variable, value) : assign(talk, variable.expression, value);
    }
  throw Refused(fmt::format("'{}' cannot be set", stl::shortened(name)));
}

Json set_expression(Conversation& talk, const Json& arguments) {
  return assign(talk, text_at(arguments, "expression"), text_at(arguments, "value"));
}

}  // namespace

std::string without_power(Conversation& talk) {
  return talk.simulation().plc().powered()
             ? std::string()
             : talk.said_of(talk.looks_at()) + "the PLC is without power; 'power on' in the console brings it back";
}

void act(Conversation& talk, Action action) {
  if (const std::string why = without_power(talk); !why.empty()) throw Refused(why);
  const History::BranchPtr before = talk.debuggee->history().here().branch;
  tools::act(*talk.session, std::move(action));
  talk.print(talk.session->take_said());
  note_branch(talk, before);
  note_change(talk);
}

void note_change(Conversation& talk) {
  talk.after_response([&talk] {
    if (talk.client.takes_invalidation && !talk.runs())
      talk.send_event("invalidated", {{"areas", Json::array({"variables"})}});
    report_memory_changes(talk);
  });
}

void note_branch(Conversation& talk, const History::BranchPtr& before) {
  if (talk.debuggee->history().here().branch == before) return;
  std::erase_if(talk.frames_sent, [now = talk.debuggee->history().now().time](Time sent) { return sent > now; });
}

void report_memory_changes(Conversation& talk) {
  if (!talk.client.takes_memory_events) return;
  for (auto& [key, area] : talk.read) {
    const LookAt look(talk, key.first);
    const auto place_of = [&talk](const std::string& reference) {
      return *find_memory(find_station(reference, talk.stations())->reference, talk.cpu().program());
    };
    auto now = bytes_of(place_of(*area.references.begin()), talk.cpu().state());
    const auto& before = area.bytes;
    const std::size_t size = std::max(before.size(), now.size());  // one of them is none: the routine is not open
    const auto same = [&](std::size_t i) { return i < before.size() && i < now.size() && before[i] == now[i]; };
    std::size_t first = 0, last = size;
    while (first < size && same(first)) ++first;
    if (first == size) continue;
    while (same(last - 1)) --last;
    for (const std::string& reference : area.references)
      talk.send_event("memory",
                      {{"memoryReference", reference},
                       {"offset", std::int64_t{key.second} + static_cast<std::int64_t>(first) - place_of(reference).at},
                       {"count", last - first}});
    area.bytes = std::move(now);
  }
}

std::vector<Request> memory_requests() {
  return {{"readMemory", read_memory},
          {"writeMemory", write_memory},
          {"setVariable", set_variable},
          {"setExpression", set_expression}};
}

}  // namespace s7200::tools::dap
