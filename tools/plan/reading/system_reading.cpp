#include "tools/plan/reading/system_reading.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/text/joined.hpp"
#include "serial_sim/system/dispatcher.hpp"
#include "tools/plan/fault_owner.hpp"

namespace s7200::tools {
namespace {

using Where = SystemKey::Where;

static_assert(3 * kMostStations + 2 * kMostYamlKeys <= serial::Dispatcher::kMostOfARank);

/// Whether the fault may be one of the station. Returns false after a complaint.
bool may_be_of(const StationPlan& station, const serial::ParsedFault& parsed, const YamlNode& what, std::string_view text,
               const YamlNode& name, YamlValues& values) {
  const auto cannot = why_not_of_station(parsed, station.kind == StationPlan::Kind::Plc);
  if (!cannot) return true;
  const YamlNode at = cannot->given ? part_of(what, text, cannot->given->column - 1, cannot->given->length) : name;
  values.wrong(at, cannot->wrong, cannot->hint);
  return false;
}

}  // namespace

bool SystemNames::take_name(const YamlNode& key, const std::string& name, YamlValues& values) {
  const auto [known, is_new] = names_.emplace(name, key.position.line);
  if (!is_new)
    values.wrong(key, fmt::format("two stations are called '{}', the first in line {}", stl::shortened(name), known->second),
                 "give each a name of its own; copies are numbered: slave1, slave2, …");
  return is_new;
}

bool SystemNames::take_station(const YamlNode& key, const std::string& name, YamlValues& values) {
  if (++stations_ == kMostStations + 1)
    values.wrong(key, fmt::format("more than {} stations: a system takes no more PLCs, peers and bridges", kMostStations),
                 "lines that have no station in common may be systems of their own");
  return stations_ <= kMostStations && take_name(key, name, values);
}

void SystemNames::take_file(const YamlNode& node, const std::string& path, YamlValues& values) {
  const auto [known, is_new] = written_.emplace(path, node.position.line);
  if (!is_new)
    values.wrong(node, fmt::format("{} is written twice, first in line {}", path, known->second),
                 "give each a name of its own");
}

void check_keys(const YamlNode& map, std::initializer_list<Where> places, YamlValues& values) {
  const auto belongs = [&](const SystemKey& key) { return std::ranges::find(places, key.where) != places.end(); };
  for (const YamlNode& key : map.keys) {
    if (std::ranges::any_of(system_keys(), [&](const SystemKey& k) { return belongs(k) && k.key == key.text; })) continue;
    std::string known;
    for (const SystemKey& k : system_keys())
      if (belongs(k)) known.append(known.empty() ? "" : ", ").append(k.key);
    values.wrong(key, fmt::format("'{}' has no place here", stl::shortened(key.text)), "known: " + known);
  }
}

std::vector<Named> entries(const YamlNode& root, std::string_view list, YamlValues& values) {
  const YamlNode* const map = root.find(list);
  if (!map) return {};
  std::vector<Named> all;
  if (!map->is_map()) {
    values.wrong(*map, fmt::format("'{}' is a map of names, not {}", list, to_text(*map)));
    return {};
  }
  for (std::size_t i = 0; i < map->keys.size(); ++i) {
    const YamlNode &key = map->keys[i], &item = map->items[i];
    if (key.text.find_first_of(". \t") != std::string::npos)
      values.wrong(key, fmt::format("'{}' is not a name", stl::shortened(key.text)), "a name has no dot and no blank");
    else if (stl::printable(key.text) != key.text)
      values.wrong(key, fmt::format("'{}' is not a name", stl::shortened(key.text)),
                   "a name has no control characters: it is printed, and written into files");
    else if (!item.is_map())
      values.wrong(item, fmt::format("'{}' is a map, not {}", stl::shortened(key.text), to_text(item)));
    else
      all.push_back({key, item});
  }
  return all;
}

std::vector<const YamlNode*> items_of(const YamlNode& map, std::string_view key, std::string_view example,
                                      YamlValues& values) {
  const YamlNode* const node = map.find(key);
  if (!node) return {};
  std::vector<const YamlNode*> items;
  if (!node->is_list())
    values.wrong(*node, fmt::format("'{}' is a list, not {}", key, to_text(*node)),
                 fmt::format("write for example {}: [{}]", key, example));
  for (const YamlNode& item : node->items)
    if (node->is_list()) items.push_back(&item);
  return items;
}

std::vector<Assignment> read_assignments(const YamlNode& set, const Program& program, YamlValues& values) {
  std::vector<Assignment> all;
  if (!set.is_map()) {
    values.wrong(set, "'set' is a map, not " + to_text(set), "write for example set: {VW20: 5, I0.3: 1}");
    return {};
  }
  for (std::size_t i = 0; i < set.keys.size(); ++i) {
    const auto value = values.text(set.items[i]);
    const auto assignment = value ? parse_assignment(fmt::format("{}={}", set.keys[i].text, *value), program) : std::nullopt;
    if (assignment)
      all.push_back(*assignment);
    else if (value)
      values.wrong(set.keys[i], assignment.why());
  }
  return all;
}

std::optional<FaultPlan> read_fault(const YamlNode& what, const YamlNode* station, const LinePlan& line,
                                    const SystemPlan& plan, YamlValues& values) {
  const auto text = values.text(what);
  if (!text) return {};
  const serial::ParsedFault parsed = serial::parse_fault(*text);
  if (parsed.error)
    values.wrong(part_of(what, *text, parsed.error->column - 1, parsed.error->length), parsed.error->message,
                 "`s7200 run --help` has the kinds of faults");
  const auto place = station ? station_on(line, *station, plan, values) : std::nullopt;
  if (parsed.error || (station && !place)) return {};
  if (place && !may_be_of(line.stations[*place], parsed, what, *text, *station, values)) return {};
  return FaultPlan{parsed.fault, place};
}

std::optional<std::size_t> station_on(const LinePlan& line, const YamlNode& node, const SystemPlan& plan,
                                      YamlValues& values) {
  const auto name = values.text(node);
  if (!name) return {};
  const auto name_of_station = [&](const StationPlan& station) { return name_of(plan, station); };
  for (std::size_t i = 0; i < line.stations.size(); ++i) {
    const std::string each = name_of_station(line.stations[i]);
    if (each == *name || fmt::format("{}.{}", each, line.stations[i].port) == *name) return i;
  }
  values.wrong(node, fmt::format("'{}' is not on line '{}'", stl::shortened(*name), line.name),
               line.stations.empty() ? "" : "known: " + stl::joined(line.stations, name_of_station));
  return {};
}

bool on_a_line(const StationPlan& station, const SystemPlan& plan) {
  return std::ranges::any_of(plan.lines, [&](const LinePlan& line) {
    return std::ranges::any_of(line.stations, [&](const StationPlan& s) {
      return s.kind == station.kind && s.number == station.number && s.port == station.port;
    });
  });
}

}  // namespace s7200::tools
