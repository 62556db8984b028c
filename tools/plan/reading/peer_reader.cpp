#include "tools/plan/reading/peer_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "interpreter/base/text/joined.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "serial_sim/modbus/address.hpp"
#include "serial_sim/modbus/request.hpp"
#include "serial_sim/westinghouse/plcs.hpp"

namespace s7200::tools {
namespace {

using Where = SystemKey::Where;

/// The word for a sync signal that is driven by the master that joins the line, instead of by an output.
constexpr std::string_view kMasterOfLine = "master";

class PeerReader {
 public:
  explicit PeerReader(SystemReading& reading) : reading_(reading) {}

  void read(const Named& peer) {
    const YamlNode& map = peer.item;
    const bool master = map.find("polls") != nullptr, other = map.find("westinghouse") != nullptr;
    if (master && other)
      check_keys(map, {Where::OtherPlc, Where::Master}, values_);
    else
      check_keys(map, {other ? Where::OtherPlc : Where::Master}, values_);
    if (master == other)
      values_.wrong(peer.key,
                    fmt::format("'{}' is {} a master {} another PLC", stl::shortened(peer.key.text),
                                master ? "both" : "neither", master ? "and" : "nor"),
                    "a master has 'polls', a PLC of another make 'westinghouse'");
    if (!names_.take_station(peer.key, peer.key.text, values_)) return;
    names_.others[peer.key.text] = {&peer.key, {StationPlan::Kind::Peer, plan().peers.size(), 0}};
    PeerPlan& plan = this->plan().peers.emplace_back();
    plan.name = peer.key.text;
    if (master) read_polls(map, plan.polls);
    if (other && !master) plan.automaton = read_other_plc(map, plan.sync);
  }

 private:
  void read_polls(const YamlNode& map, serial::PollPlan& polls) {
    polls.starts = values_.duration(map.find("starts")).value_or(polls.starts);
    polls.every = values_.duration(map.find("every")).value_or(0);
    const Time timeout = values_.duration(map.find("timeout")).value_or(kSecond);
    for (const YamlNode* poll : items_of(map, "polls", "{station: 1..3, read: 40001, count: 10}", values_)) {
      if (!poll->is_map()) {
        values_.wrong(*poll, "what is polled is a map, not " + to_text(*poll),
                      "write for example {station: 1, read: 40001}");
        continue;
      }
      check_keys(*poll, {Where::Poll}, values_);
      const auto stations = read_stations(*poll);
      const auto pdu = read_request(*poll);
      if (!stations || !pdu) continue;
      for (std::int64_t station = stations->least; station <= stations->most; ++station)
        polls.requests.push_back(
            {.frame = serial::to_frame(modbus::rtu_frame(static_cast<std::uint8_t>(station), *pdu)), .timeout = timeout});
    }
    if (polls.requests.empty() && values_.complaints.count() == 0)
      values_.wrong(*map.find("polls"), "nothing to ask", "write for example polls: [{station: 1, read: 40001}]");
  }

  std::optional<Between<std::int64_t>> read_stations(const YamlNode& poll) {
    const YamlNode* const node = poll.find("station");
    if (!node) return Between<std::int64_t>{1, 1};
    return values_.value(node, fmt::format("a station from 1 to {}, or FIRST..LAST", modbus::kLastStation), "5, 1..31",
                         [](const std::string& t) -> std::optional<Between<std::int64_t>> {
                           const std::size_t dots = t.find("..");
                           const auto first = parse_integer(stl::trim(std::string_view(t).substr(0, dots)));
                           const auto last = dots == std::string::npos
                                                 ? first
                                                 : parse_integer(stl::trim(std::string_view(t).substr(dots + 2)));
                           if (!first || !last || *first < 1 || *last < *first || *last > modbus::kLastStation) return {};
                           return Between<std::int64_t>{*first, *last};
                         });
  }

  std::optional<modbus::DataAddress> read_data_address(const YamlNode& node) {
    const auto text = values_.text(node);
    if (!text) return {};
    const auto address = modbus::parse_address(*text);
    if (!address) values_.wrong(node, address.why());
    return address.if_any();
  }

  std::optional<Bytes> read_request(const YamlNode& poll) {
    const YamlNode *const reads = poll.find("read"), *const writes = poll.find("write");
    if ((reads == nullptr) == (writes == nullptr)) {
      values_.wrong(poll, "what is polled has one of 'read' and 'write'", "write for example {station: 1, read: 40001}");
      return {};
    }
    const auto address = read_data_address(reads ? *reads : *writes);
    if (!address) return {};
    return reads ? read_read(poll, *address) : read_write(poll, *address);
  }

  std::optional<Bytes> read_read(const YamlNode& poll, const modbus::DataAddress& address) {
    const YamlNode *const count = poll.find("count"), *const value = poll.find("value");
    if (value) values_.wrong(*value, "'value' has no place beside 'read'", "it is what is written with 'write'");
    const auto number = count ? values_.number(count, 1, UINT16_MAX) : 1;
    if (value || !number) return {};
    Bytes pdu = read_of(address, static_cast<std::uint16_t>(*number));
    const std::string why = modbus::beyond_limits(pdu);
    if (why.empty()) return pdu;
    values_.wrong(count ? *count : *poll.find("read"), why);
    return {};
  }

  std::optional<Bytes> read_write(const YamlNode& poll, const modbus::DataAddress& address) {
    if (const YamlNode* const count = poll.find("count")) {
      values_.wrong(*count, "'count' has no place beside 'write'",
                    "one coil or register is written; several are several polls");
      return {};
    }
    if (!poll.find("value")) {
      values_.wrong(poll, "'write' without the 'value' to write");
      return {};
    }
    const auto value = values_.number(poll.find("value"), INT16_MIN, UINT16_MAX);
    if (!value) return {};
    if (address.area == modbus::Area::Coils) return modbus::write_coil(address.address, *value != 0);
    if (address.area == modbus::Area::HoldingRegisters)
      return modbus::write_register(address.address, static_cast<std::uint16_t>(*value));
    values_.wrong(*poll.find("write"), "inputs cannot be written", "write a coil (00001) or a holding register (40001)");
    return {};
  }

  static Bytes read_of(const modbus::DataAddress& from, std::uint16_t count) {
    switch (from.area) {
      case modbus::Area::Coils:
        return modbus::read_coils(from.address, count);
      case modbus::Area::Inputs:
        return modbus::read_inputs(from.address, count);
      case modbus::Area::InputRegisters:
        return modbus::read_input_registers(from.address, count);
      case modbus::Area::HoldingRegisters:
        return modbus::read_holding_registers(from.address, count);
    }
    return {};
  }

  std::shared_ptr<const serial::Automaton> read_other_plc(const YamlNode& map, std::optional<PeerPlan::Output>& sync) {
    const YamlNode& protocol = *map.find("westinghouse");
    const auto name = values_.text(protocol);
    const westinghouse::PlcRow* const row = name ? westinghouse::find_plc(*name) : nullptr;
    if (!row) {
      if (name)
        values_.wrong(protocol, fmt::format("there is no protocol '{}'", stl::shortened(*name)),
                      "there are " + stl::joined(westinghouse::plcs(), &westinghouse::PlcRow::name));
      return nullptr;
    }
    const std::size_t before = values_.complaints.count();
    const std::string model = values_.optional_text(map, "model").value_or(std::string(row->models.front()));
    auto made = westinghouse::make_plc(*row, model);
    if (!made) values_.wrong(*map.find("model"), made.why());
    const std::shared_ptr<westinghouse::Plc> plc = made ? *std::move(made) : nullptr;
    const auto settings = items_of(map, "settings", "unit=05", values_);
    for (const bool cells : {false, true})
      for (const YamlNode* setting : settings) {
        if ((plc && plc->names_cells(setting->text)) != cells) continue;
        const auto text = values_.text(*setting);
        if (!plc || !text) continue;
        if (const auto done = plc->set(*text); !done) values_.wrong(*setting, done.why());
      }
    for (const YamlNode* setting : settings) {
      if (!plc || values_.complaints.count() > before) break;
      if (const auto done = plc->still_reaches(setting->text); !done) values_.wrong(*setting, done.why());
    }
    if (!plc || values_.complaints.count() > before) return plc;
    const YamlNode* const wire = map.find("sync");
    if (wire && !plc->needs_sync())
      values_.wrong(*wire, "this PLC has no sync signal, or ignores it", "the PC1000 LAN with sync=required has one");
    else if (wire && wire->text != kMasterOfLine)
      sync = read_output(*wire);
    else if (!wire && plc->needs_sync())
      values_.wrong(protocol, "nothing drives the sync signal that this PLC needs to hear anything",
                    "write sync: gateway.Q0.0, sync: master, or settings: [sync=ignored]");
    return plc;
  }

  /// Reads an output: `gateway.Q0.0`
  std::optional<PeerPlan::Output> read_output(const YamlNode& node) {
    constexpr const char* kExample = "write for example gateway.Q0.0";
    const auto written = values_.text(node);
    if (!written) return {};
    const std::size_t dot = written->find('.');
    const std::string name = written->substr(0, dot);
    const auto plc = std::ranges::find(plan().plcs, name, &PlcPlan::name);
    if (dot == std::string::npos || plc == plan().plcs.end()) {
      values_.wrong(node, fmt::format("'{}' is not an output of a PLC", stl::shortened(*written)), kExample);
      return {};
    }
    if (!plc->program) return {};
    const auto output = parse_range(written->substr(dot + 1), *plc->program);
    if (!output || output->area != Area::Q || output->width != Width::Bit || output->count != 1) {
      values_.wrong(
          node, output ? fmt::format("'{}' is not an output point", stl::shortened(written->substr(dot + 1))) : output.why(),
          kExample);
      return {};
    }
    return PeerPlan::Output{static_cast<std::size_t>(plc - plan().plcs.begin()), {output->number, output->bit}};
  }

  SystemPlan& plan() { return reading_.file.plan; }

  SystemReading& reading_;
  SystemNames& names_ = reading_.names;
  YamlValues& values_ = reading_.values;
};

}  // namespace

void read_peers(const YamlNode& root, SystemReading& reading) {
  PeerReader reader(reading);
  for (const Named& each : entries(root, "peers", reading.values)) reader.read(each);
}

}  // namespace s7200::tools
