#include "tools/plan/reading/line_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "interpreter/base/listen_address.hpp"
#include "interpreter/base/text/joined.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "serial_sim/line/line.hpp"
#include "tools/yaml/names.hpp"

namespace s7200::tools {
namespace {

using Where = SystemKey::Where;

class LineReader {
 public:
  explicit LineReader(SystemReading& reading) : reading_(reading) {}

  void read_bridge(const Named& bridge) {
    const YamlNode& map = bridge.item;
    check_keys(map, {Where::Bridge}, values_);
    if (!names_.take_station(bridge.key, bridge.key.text, values_)) return;
    if (map.keys.size() != 1)
      return values_.wrong(bridge.key, fmt::format("'{}' is not one kind of bridge", bridge.key.text),
                           "write for example {tcp: 5020}");
    const auto row = std::ranges::find(kBridges, map.keys[0].text, &BridgeRow::word);
    if (row == kBridges.end()) return;  // check_keys() has said so
    BridgePlan plan{bridge.key.text, row->kind, name_from(map.items[0], values_).value_or("")};
    if (plan.kind == BridgeKind::Pty) plan.where = beside(reading_.path, plan.where);
    if (const std::string place = place_of(plan, map.items[0]); !place.empty()) {
      const auto [known, is_new] = names_.served.emplace(place, bridge.key.position.line);
      if (!is_new)
        values_.wrong(map.items[0], fmt::format("two bridges at {}, the first in line {}", plan.where, known->second));
    }
    names_.others[plan.name] = {&bridge.key, {StationPlan::Kind::Bridge, this->plan().bridges.size(), 0}};
    this->plan().bridges.push_back(std::move(plan));
  }

  void read_line(const Named& line) {
    const YamlNode& map = line.item;
    check_keys(map, {Where::Line}, values_);
    LinePlan& plan = this->plan().lines.emplace_back();
    plan.name = line.key.text;
    if (std::ranges::find(this->plan().plcs, plan.name, &PlcPlan::name) != this->plan().plcs.end())
      values_.wrong(line.key, fmt::format("a PLC is called '{}' too", stl::shortened(plan.name)),
                    "give the line a name of its own: --at and 'on' take either");
    read_settings(map, plan);
    for (const YamlNode* item : items_of(map, "capture", "bus.pcap", values_))
      if (const auto written = name_from(*item, values_)) {
        plan.captures.push_back(beside(reading_.path, *written));
        names_.take_file(*item, plan.captures.back(), values_);
      }
    for (const YamlNode* item : items_of(map, "stations", "master, slave", values_)) read_station(*item, plan);
    if (const YamlNode* const master = map.find("master")) plan.master = station_on(plan, *master, this->plan(), values_);
    read_faults(map, plan);
    check(line, plan);
    read_turn_round(map, plan);
  }

 private:
  /// The place that only one bridge can have: a link, a device, a port of an address. Empty for a port that is free then,
  /// and after a complaint.
  std::string place_of(const BridgePlan& bridge, const YamlNode& where) {
    if (row_of(bridge.kind).place != kPortPlace) return bridge.where;
    const auto address = parse_listen_address(bridge.where);
    if (!address) values_.wrong(where, address.why(), "write for example 5020 or 0.0.0.0:5020");
    return address && address->port != 0 ? to_text(*address) : "";
  }

  /// Reads the format in which masters and bridges talk on the line.
  void read_settings(const YamlNode& map, LinePlan& plan) {
    read_line_settings(map, plan.settings, values_);
    const YamlNode* const contention = map.find("contention");
    if (contention && contention->text == "space")
      plan.contention.reset();
    else if (const auto seed = values_.number(contention, 0, UINT32_MAX))
      plan.contention = static_cast<std::uint64_t>(*seed);
  }

  /// Complains about who is on it, and who is not.
  void check(const Named& line, const LinePlan& plan) {
    const YamlNode& map = line.item;
    if (plan.stations.empty() && values_.complaints.count() == 0)
      values_.wrong(line.key, fmt::format("no one is on line '{}'", line.key.text), "name them: stations: [master, slave]");
    if (!plan.captures.empty() && values_.complaints.count() == 0 && !first_plc(plan) &&
        !first_other_plc(this->plan(), plan))
      values_.wrong(*map.find("capture"), fmt::format("no PLC is on line '{}': rx and tx are those of one", line.key.text));
    if (plan.stations.size() > static_cast<std::size_t>(serial::Line::kDrivers))
      values_.wrong(*map.find("stations"),
                    fmt::format("{} stations: a line takes {}", plan.stations.size(), serial::Line::kDrivers),
                    "more need a repeater; a second line and a gateway with two ports do it too");
  }

  void read_turn_round(const YamlNode& map, const LinePlan& line) {
    const auto pause = values_.duration(map.find("turn_round"));
    if (!pause) return;
    bool any = false;
    for (const StationPlan& station : line.stations) {
      if (station.kind != StationPlan::Kind::Peer) continue;
      serial::PollPlan& polls = plan().peers[station.number].polls;
      polls.pause = *pause;
      any = any || !polls.requests.empty();
    }
    if (!any && values_.complaints.count() == 0)
      values_.wrong(*map.find("turn_round"),
                    fmt::format("no peer on line '{}' is a master: none keeps this pause", line.name));
  }

  void read_faults(const YamlNode& map, LinePlan& line) {
    for (const YamlNode* item : items_of(map, "faults", "\"noise:ber=1e-5\"", values_)) {
      if (item->is_map()) check_keys(*item, {Where::Fault}, values_);
      const YamlNode* const what = item->is_map() ? item->find("fault") : item;
      if (!what)
        values_.wrong(*item, "a fault of a station without the 'fault' itself",
                      "write for example {fault: parity, station: slave}");
      else if (const auto fault = read_fault(*what, item->find("station"), line, plan(), values_))
        line.faults.push_back(*fault);
    }
  }

  void read_station(const YamlNode& node, LinePlan& line) {
    const auto written = values_.text(node);
    if (!written) return;
    const std::size_t dot = written->find('.');
    const std::string name = written->substr(0, dot);
    const auto port = dot == std::string::npos ? std::optional<std::uint8_t>(0)
                                               : parse_decimal<std::uint8_t>(std::string_view(*written).substr(dot + 1));
    if (!port || *port > 1)
      return values_.wrong(node, fmt::format("'{}' has no port", stl::shortened(*written)),
                           "write for example gateway.0 or gateway.1");
    if (const auto other = names_.others.find(name); other != names_.others.end()) {
      if (dot != std::string::npos)
        return values_.wrong(node, fmt::format("'{}' has one port only", name), "leave the number out");
      return put_on(node, line, other->second.plan, name);
    }
    const auto group = names_.groups.find(name);
    if (group != names_.groups.end()) {
      for (const std::size_t plc : group->second) put_plc_on(node, line, plc, *port);
      return;
    }
    for (std::size_t i = 0; i < plan().plcs.size(); ++i)
      if (plan().plcs[i].name == name) return put_plc_on(node, line, i, *port);
    values_.wrong(node, fmt::format("there is no station '{}'", stl::shortened(name)), "known: " + known_stations());
  }

  std::string known_stations() {
    const auto name_of = [](const auto& entry) { return entry.first; };
    const std::string plcs = stl::joined(names_.groups, name_of), others = stl::joined(names_.others, name_of);
    if (plcs.empty() && others.empty()) return "none; 'plcs' and 'peers' name them";
    return plcs + (plcs.empty() || others.empty() ? "" : ", ") + others;
  }

  void put_plc_on(const YamlNode& node, LinePlan& line, std::size_t number, std::uint8_t port) {
    const PlcPlan& plc = plan().plcs[number];
    const CpuModel* const model = plc.program ? plc.program->model : nullptr;  // null after a complaint
    if (model && port >= model->ports)
      return values_.wrong(node, fmt::format("CPU {} has no port {}", model->name, port),
                           fmt::format("a second port needs {}", s7200::to_text(kTwoPorts)));
    put_on(node, line, {StationPlan::Kind::Plc, number, port}, plc.name);
  }

  void put_on(const YamlNode& node, LinePlan& line, const StationPlan& station, const std::string& name) {
    if (!on_a_line(station, plan())) return line.stations.push_back(station);
    const std::string port = station.kind == StationPlan::Kind::Plc ? fmt::format("port {} of ", station.port) : "";
    values_.wrong(node, fmt::format("{}'{}' is on a line already", port, name), "a port is on one line, and there once");
  }

  SystemPlan& plan() { return reading_.file.plan; }

  SystemReading& reading_;
  SystemNames& names_ = reading_.names;
  YamlValues& values_ = reading_.values;
};

}  // namespace

void read_bridges(const YamlNode& root, SystemReading& reading) {
  for (const Named& each : entries(root, "bridges", reading.values)) LineReader(reading).read_bridge(each);
}

void read_lines(const YamlNode& root, SystemReading& reading) {
  for (const Named& each : entries(root, "lines", reading.values)) LineReader(reading).read_line(each);
}

void read_line_settings(const YamlNode& map, serial::LineSettings& line, YamlValues& values) {
  if (const auto baud = values.number(map.find("baud"), kLeastBaud, kMostBaud))
    line.baud = static_cast<std::uint32_t>(*baud);
  if (const auto parity =
          values.choice<Parity>(map.find("parity"), {{"none", Parity::None}, {"even", Parity::Even}, {"odd", Parity::Odd}}))
    line.parity = *parity;
  if (const auto bits = values.number(map.find("data_bits"), 7, 8)) line.data_bits = static_cast<std::uint8_t>(*bits);
  if (const auto bits = values.number(map.find("stop_bits"), 1, 2)) line.stop_bits = static_cast<std::uint8_t>(*bits);
}

}  // namespace s7200::tools
