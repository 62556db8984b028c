#include "tools/session/commands/looked_at.hpp"

#include <algorithm>
#include <utility>

#include "interpreter/cpu/units/forcing.hpp"

namespace s7200::tools {

void note_looked_at(Session& session, const Place& place) {
  const Cpu& cpu = session.cpu();
  if (const auto range = range_now(place, cpu))
    session.looked_at.push_back({session.history.here().branch->power, session.focus(), session.history.now(), *range,
                                 forcing::seen_outside(cpu.state(), *range)});
}

std::vector<SessionRecord::LookedAt> looked_at_here(Session& session) {
  const Moment here = session.history.now();
  const auto power_here = session.history.here().branch->power;
  std::vector<SessionRecord::LookedAt> all;
  for (const auto& [power, station, moment, range, bytes] : session.looked_at) {
    if (power != power_here || moment > here) continue;
    session.history.go_to(moment);
    const State& state = session.stations[station].simulation->cpu().state();
    if (session.history.now() != moment || forcing::seen_outside(state, range) != bytes) continue;
    SessionRecord::LookedAt one{.station = station, .at = moment.time, .actions = moment.actions, .memory = {}};
    for (std::uint32_t i = 0; i < range.count; ++i) one.memory.push_back(object_of(state, range, i));
    all.push_back(std::move(one));
  }
  session.history.go_to(here);
  std::ranges::stable_sort(all, {}, &SessionRecord::LookedAt::at);
  return all;
}

std::vector<std::vector<SessionRecord::LookedAt>> looked_at_since_the_beginning(Session& session) {
  std::vector<std::vector<SessionRecord::LookedAt>> all{looked_at_here(session)};
  for (auto power = session.history.here().branch->power; power; power = power->before.power)
    all.push_back(session.looked_at_before[power]);
  std::ranges::reverse(all);
  return all;
}

Assignment object_of(const State& state, const MemoryRange& range, std::uint32_t i) {
  MemoryRange place = range;
  place.count = 1;
  const bool element = info(range.area).element != 0;
  place.number = range.number + i * (element ? 1 : s7200::bytes_of(range.width));
  place.at = range.at + i * (element ? info(range.area).element : s7200::bytes_of(range.width));
  if (range.area == Area::AC) {
    place.at -= 4 - s7200::bytes_of(range.width);
    place.width = Width::Double;
  }
  std::uint32_t value = 0;
  for (const std::uint8_t byte : forcing::seen_outside(state, place)) value = value << 8 | byte;
  return {place, value};
}

}  // namespace s7200::tools
