#include "tools/session/commands/saved_stops.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/text/text.hpp"
#include "tools/session/commands/memory_words.hpp"
#include "tools/session/stops/stop_words.hpp"

namespace s7200::tools {
namespace {

using On = StopPoint::On;

/// `VW100:4`, `VD20:real`, `AC1:byte`: as parse_place() reads it.
std::string address_of(const MemoryRange& range) {
  const bool part = range.area == Area::AC && range.width != Width::Double;
  const std::string_view type = range.real ? ":real" : !part ? "" : range.width == Width::Byte ? ":byte" : ":word";
  return range.name_of(0) + (range.count > 1 ? fmt::format(":{}", range.count) : "") + std::string(type);
}

SessionFile::SavedStop saved(const StopPoint& stop) {
  const auto access = std::ranges::find(kAccesses, stop.on, &AccessWord::on);
  return {.number = stop.number,
          .station = stop.station,
          .on = stop.is_watch() ? address_of(*stop.range) : stop.name,
          .access = stop.is_watch() ? std::string(access->word) : "",
          .always = stop.on == On::Place && !stop.needs_power,
          .condition = stop.condition && stop.on != On::Becomes ? stop.condition->text() : "",
          .from_hit = stop.from_hit,
          .log = stop.log};
}

std::optional<StopPoint> stop_of(const Session& session, const SessionFile::SavedStop& saved) {
  const Session::Station& of = session.stations[saved.station];
  const Program& program = of.simulation->cpu().program();
  std::string note;
  std::optional<StopPoint> stop;
  if (saved.access.empty()) {
    stop = find_stop(stl::split_words(saved.on), program, of.listing, note).if_any();
  } else if (const auto place = parse_place(saved.on, program); place && !place->pointer) {
    const auto access = std::ranges::find(kAccesses, saved.access, &AccessWord::word);
    if (access == std::end(kAccesses)) return {};
    stop = StopPoint{.on = access->on, .range = place->range, .name = address_name(program, place->range, saved.on)};
    if (stop->on != On::Change) stop->name += fmt::format(" {}", access->word);
  }
  if (!stop || !check_message(saved.log, program)) return {};
  if (!saved.condition.empty()) {
    stop->condition = Expression::parse(saved.condition, program).if_any();
    if (!stop->condition) return {};
  }
  stop->number = saved.number;
  stop->station = saved.station;
  if (saved.always) stop->needs_power = false;
  stop->from_hit = saved.from_hit;
  stop->log = saved.log;
  return stop;
}

}  // namespace

std::vector<SessionFile::SavedStop> saved_stops(const Session& session) {
  std::vector<SessionFile::SavedStop> all;
  for (const StopPoint& stop : session.stepper.stops())
    if (stop_of(session, saved(stop))) all.push_back(saved(stop));
  return all;
}

Result<std::vector<StopPoint>> stops_of(const Session& session, const SessionFile& file) {
  std::vector<StopPoint> stops;
  for (const SessionFile::SavedStop& saved : file.stops) {
    const auto stop = stop_of(session, saved);
    if (!stop) return trouble("it is damaged: a breakpoint or watch at '{}'", stl::shortened(saved.on));
    stops.push_back(*stop);
  }
  return stops;
}

std::size_t add_loaded(Session& session, std::vector<StopPoint> stops) {
  std::size_t added = 0;
  for (StopPoint& stop : stops) {
    const auto is_same = [&](const StopPoint& other) {
      SessionFile::SavedStop its = saved(other);
      its.number = stop.number;
      return its == saved(stop);
    };
    if (std::ranges::any_of(session.stepper.stops(), is_same)) continue;
    if (std::ranges::find(session.stepper.stops(), stop.number, &StopPoint::number) != session.stepper.stops().end())
      stop.number = session.next_number;
    session.next_number = std::max(session.next_number, stop.number + 1);
    session.stepper.add(std::move(stop));
    ++added;
  }
  return added;
}

}  // namespace s7200::tools
