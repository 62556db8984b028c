// Reading and writing memory, and what the client is told when it changes.
#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/text.hpp"
#include "tools/dap/addresses.hpp"
#include "tools/dap/base64.hpp"
#include "tools/dap/session.hpp"
#include "tools/views/machine_text.hpp"
#include "tools/views/memory.hpp"

namespace s7200::tools::dap {
namespace {

MemoryPlace memory_at(const Json& arguments, const Program& program) {
  const auto reference = arguments.at("memoryReference").get<std::string>();
  const auto place = find_memory(reference, program);
  if (!place)
    throw Refused(fmt::format("'{}' is not memory of this CPU; write for example V, VB100, AC0", stl::shortened(reference)));
  return *place;
}

}  // namespace

std::vector<std::uint8_t> Session::bytes_at(std::uint32_t begin, std::uint32_t end) const {
  const auto& image = cpu().state().image;
  return {image.begin() + begin, image.begin() + end};
}

Json Session::read_memory(const Json& arguments) {
  const MemoryPlace place = memory_at(arguments, cpu().program());
  const std::int64_t count = amount_in(arguments, "count", 0);
  const std::int64_t first = place.at + amount_in(arguments, "offset", 0);
  const std::int64_t begin = std::clamp<std::int64_t>(first, place.begin, place.end);
  const std::int64_t end = std::clamp<std::int64_t>(first + std::max<std::int64_t>(count, 0), begin, place.end);
  const auto bytes = bytes_at(static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end));
  if (!bytes.empty()) {  // to tell when it changes, an area is looked at as a whole
    const auto reference = arguments["memoryReference"].get<std::string>();
    read_[reference] = bytes_at(place.begin, place.end);
  }
  Json body{{"address", address_text(begin)}};
  if (first + count > end) body["unreadableBytes"] = std::max<std::int64_t>(0, first + count - end);
  if (!bytes.empty()) body["data"] = to_base64(bytes);
  return body;
}

Json Session::write_memory(const Json& arguments) {
  const MemoryPlace place = memory_at(arguments, cpu().program());
  const auto bytes = from_base64(arguments.at("data").get<std::string>());
  if (!bytes) throw Refused("data is not base64");
  const std::int64_t first = place.at + amount_in(arguments, "offset", 0);
  const bool partial = arguments.value("allowPartial", false);
  const std::int64_t room = first < place.begin ? 0 : std::max<std::int64_t>(0, place.end - first);
  const auto count = std::min(static_cast<std::int64_t>(bytes->size()), room);
  if (count < static_cast<std::int64_t>(bytes->size()) && !partial)
    throw Refused(fmt::format("{} bytes from there run past the end of the area", bytes->size()));
  SetMemory set;
  for (const AreaInfo& area : all_areas()) {
    if (area.base != place.begin) continue;
    for (std::int64_t i = 0; i < count; ++i) {
      const auto at = static_cast<std::uint32_t>(first + i);
      set.assignments.push_back({{.area = area.area, .width = Width::Byte, .number = at - area.base, .at = at},
                                 (*bytes)[static_cast<std::size_t>(i)]});
    }
  }
  act(std::move(set));
  return {{"bytesWritten", count}};
}

MemoryRange Session::range_for(const std::string& expression) const {
  std::string why;
  const auto place = parse_place(expression, cpu().program(), why);
  if (!place) throw Refused(why);
  const auto range = range_now(*place, cpu());
  if (!range) throw Refused(fmt::format("{} points nowhere", expression));
  return *range;
}

Json Session::assign(const std::string& expression, const std::string& value) {
  const MemoryRange range = range_for(expression);
  const auto assignment = parse_value(range, value);
  if (!assignment)
    throw Refused(
        fmt::format("'{}' is not a value that fits {}; write for example 5, 16#FF, 1.5", stl::shortened(value), expression));
  act(SetMemory{{*assignment}});
  const Variable variable = variable_of(cpu(), range, expression);
  Json body{{"value", variable.value}, {"type", variable.type}, {"memoryReference", variable.memory}};
  if (range.area == Area::I && standing_at(cpu().state()))
    print("the input points are set; the program finds them in I when the next scan reads its inputs");
  return body;
}

Json Session::set_variable(const Json& arguments) {
  const auto name = arguments.at("name").get<std::string>();
  const auto container = arguments.at("variablesReference").get<Container>();
  for (const Variable& variable : variables_of(debuggee_->simulation(), debuggee_->history(), container))
    if (variable.name == name && !variable.expression.empty())
      return assign(variable.expression, arguments.at("value").get<std::string>());
  throw Refused(fmt::format("'{}' cannot be set", stl::shortened(name)));
}

Json Session::set_expression(const Json& arguments) {
  return assign(arguments.at("expression").get<std::string>(), arguments.at("value").get<std::string>());
}

/// In the past it begins a new branch, and says so.
void Session::act(Action action) {
  History& history = debuggee_->history();
  const bool branches = history.in_the_past();
  const Time left = history.newest().time;
  history.act(std::move(action));
  if (branches) {
    print(fmt::format("a new branch begins here; what ran up to {} is on the old one", moment_text(left)));
    note_new_branch();
  }
  after_response([this] {
    if (client_takes_invalidation_ && !runs()) send_event("invalidated", {{"areas", Json::array({"variables"})}});
    report_memory_changes();
  });
}

/// A record of what went on cannot go back: a capture ends, a trace says so by its times.
void Session::note_new_branch() {
  debuggee_->simulation().set_wire_sink(nullptr);
  const std::string files = debuggee_->recorded_files();
  if (files.empty() || std::exchange(captures_end_, true)) return;
  print(fmt::format("{}: traces go on with what is new, after what ran before; captures of the line end", files));
}

/// Of what the client has read: the bytes from the first to the last that is different now.
void Session::report_memory_changes() {
  if (!client_takes_memory_events_) return;
  for (auto& [reference, before] : read_) {
    const auto place = find_memory(reference, cpu().program());
    const auto now = bytes_at(place->begin, place->end);
    const auto first = std::ranges::mismatch(before, now).in1 - before.begin();
    if (first == static_cast<std::ptrdiff_t>(now.size())) continue;
    std::size_t last = now.size() - 1;
    while (before[last] == now[last]) --last;
    send_event("memory", {{"memoryReference", reference},
                          {"offset", static_cast<std::int64_t>(place->begin) + first - place->at},
                          {"count", static_cast<std::int64_t>(last) - first + 1}});
    before = now;
  }
}

}  // namespace s7200::tools::dap
