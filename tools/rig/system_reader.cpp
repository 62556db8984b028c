#include "tools/rig/system_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include "interpreter/base/numbers.hpp"
#include "interpreter/model/named_times.hpp"
#include "interpreter/program/constants.hpp"
#include "interpreter/program/load.hpp"
#include "interpreter/program/load_times.hpp"
#include "interpreter/program/slips.hpp"
#include "interpreter/stl/printer.hpp"
#include "serial_sim/line/line.hpp"
#include "serial_sim/modbus/address.hpp"
#include "serial_sim/modbus/request.hpp"
#include "serial_sim/system/dispatcher.hpp"
#include "serial_sim/westinghouse/plcs.hpp"
#include "tools/host/listen_address.hpp"
#include "tools/rig/clock_text.hpp"
#include "tools/rig/system_keys.hpp"
#include "tools/yaml/values.hpp"

namespace s7200::tools {
namespace {

using Where = SystemKey::Where;

constexpr std::int64_t kMostCopies = serial::Line::kDrivers;

/// Of a whole system. A PLC with two ports and a sync signal takes three numbers of a rank, a master two; whoever joins a
/// line takes two more.
constexpr std::size_t kMostStations = 1000;
static_assert(3 * kMostStations + 2 * kMostYamlKeys <= serial::Dispatcher::kMostOfARank);

/// Where our Modbus slaves and Application Tip 41 keep their station address.
constexpr std::string_view kStationByte = "VB4095";

/// A key of a map, and its value.
struct Named {
  const YamlNode& key;
  const YamlNode& item;
};

class Reader {
 public:
  Reader(SystemFile& file, const std::string& path, YamlValues& values) : file_(file), path_(path), values_(values) {}

  void read(const YamlNode& root) {
    if (!root.is_map())
      return values_.wrong(root, "a system file is a map, not " + to_text(root), "begin with 'plcs:' and 'lines:'");
    check_keys(root, {Where::File});
    for (const Named& each : entries(root, "plcs")) read_plc(each);
    for (const Named& each : entries(root, "peers")) read_peer(each);
    for (const Named& each : entries(root, "bridges")) read_bridge(each);
    for (const Named& each : entries(root, "lines")) read_line(each);
    if (plan().lines.empty() && values_.complaints.count() == 0)
      values_.wrong(root, "no line: no one would hear another",
                    "write for example lines: {bus: {stations: [master, slave]}}");
    if (values_.complaints.count() == 0)
      for (const YamlNode* event : list(root, "events", "{at: 1s, power_off: slave}")) read_event(*event);
    std::ranges::stable_sort(plan().events, {}, &EventPlan::at);
    if (values_.complaints.count() == 0) check_all_are_on_lines();
  }

  /// What is done in an event; nothing after a complaint.
  std::optional<EventPlan> read_what(const YamlNode& node) {
    const EventWord* done = nullptr;
    for (const EventWord& each : event_words()) {
      if (!node.find(each.word)) continue;
      if (done) {
        values_.wrong(node, fmt::format("both '{}' and '{}'", done->word, each.word), "one is done at a time");
        return {};
      }
      done = &each;
    }
    if (!done) {
      values_.wrong(node, "nothing is done in this event", std::string(kEventExample));
      return {};
    }
    EventPlan event{.what = done->what};
    const bool good = only_its_own_beside(node, *done) && read_object(node, *node.find(done->word), event);
    return good ? std::optional(event) : std::nullopt;
  }

 private:
  SystemPlan& plan() { return file_.plan; }

  // --- keys and names ---

  void check_keys(const YamlNode& map, std::initializer_list<Where> places) {
    const auto belongs = [&](const SystemKey& key) { return std::ranges::find(places, key.where) != places.end(); };
    for (const YamlNode& key : map.keys) {
      if (std::ranges::any_of(system_keys(), [&](const SystemKey& k) { return belongs(k) && k.key == key.text; })) continue;
      std::string known;
      for (const SystemKey& k : system_keys())
        if (belongs(k)) known.append(known.empty() ? "" : ", ").append(k.key);
      values_.wrong(key, fmt::format("'{}' has no place here", stl::shortened(key.text)), "known: " + known);
    }
  }

  /// Names, and a map for each.
  std::vector<Named> entries(const YamlNode& root, std::string_view list) {
    const YamlNode* const map = root.find(list);
    if (!map) return {};
    std::vector<Named> all;
    if (!map->is_map()) {
      values_.wrong(*map, fmt::format("'{}' is a map of names, not {}", list, to_text(*map)));
      return {};
    }
    for (std::size_t i = 0; i < map->keys.size(); ++i) {
      const YamlNode &key = map->keys[i], &item = map->items[i];
      if (key.text.find_first_of(". \t") != std::string::npos)
        values_.wrong(key, fmt::format("'{}' is not a name", stl::shortened(key.text)), "a name has no dot and no blank");
      else if (!item.is_map())
        values_.wrong(item, fmt::format("'{}' is a map, not {}", stl::shortened(key.text), to_text(item)));
      else
        all.push_back({key, item});
    }
    return all;
  }

  /// A station's name is its own. False after a complaint.
  bool take_name(const YamlNode& key, const std::string& name) {
    const auto [known, is_new] = names_.emplace(name, key.position.line);
    if (!is_new)
      values_.wrong(key,
                    fmt::format("two stations are called '{}', the first in line {}", stl::shortened(name), known->second),
                    "give each a name of its own; copies are numbered: slave1, slave2, …");
    return is_new;
  }

  /// One station more, with a name of its own. False after a complaint.
  bool take_station(const YamlNode& key, const std::string& name) {
    if (++stations_ == kMostStations + 1)
      values_.wrong(key, fmt::format("more than {} stations: a system takes no more PLCs, peers and bridges", kMostStations),
                    "lines that have no station in common may be systems of their own");
    return stations_ <= kMostStations && take_name(key, name);
  }

  std::vector<const YamlNode*> list(const YamlNode& map, std::string_view key, std::string_view example) {
    const YamlNode* const node = map.find(key);
    if (!node) return {};
    std::vector<const YamlNode*> items;
    if (!node->is_list())
      values_.wrong(*node, fmt::format("'{}' is a list, not {}", key, to_text(*node)),
                    fmt::format("write for example {}: [{}]", key, example));
    for (const YamlNode& item : node->items)
      if (node->is_list()) items.push_back(&item);
    return items;
  }

  std::vector<std::string> texts(const YamlNode& map, std::string_view key, std::string_view example) {
    std::vector<std::string> all;
    for (const YamlNode* item : list(map, key, example))
      if (const auto text = values_.text(*item)) all.push_back(*text);
    return all;
  }

  std::string path(const YamlNode& map, std::string_view key) {
    const auto written = values_.optional_text(map, key);
    return written ? beside(path_, *written) : "";
  }

  // --- PLCs ---

  void read_plc(const Named& plc) {
    const YamlNode& map = plc.item;
    check_keys(map, {Where::Plc});
    const CpuModel* const model = read_cpu(map);
    const std::int64_t copies = values_.number(map.find("copies"), 1, kMostCopies).value_or(1);
    const bool numbered = map.find("copies") != nullptr;
    const auto station = values_.number(map.find("station"), 1, modbus::kLastStation - (copies - 1));
    const std::size_t before = values_.complaints.count();
    std::vector<std::size_t>& those = groups_[plc.key.text];
    if (numbered) take_name(plc.key, plc.key.text);
    for (std::int64_t copy = 0; copy < copies; ++copy) {
      const std::string name = numbered ? fmt::format("{}{}", plc.key.text, copy + 1) : plc.key.text;
      if (!take_station(plc.key, name)) return;
      those.push_back(plan().plcs.size());
      plc_keys_.push_back(&plc.key);
      PlcPlan& each = plan().plcs.emplace_back();
      each.name = name;
      if (!model) continue;
      each.program = read_program(plc, *model, station ? std::optional(*station + copy) : std::nullopt);
      if (each.program) read_settings(map, each, copies > 1);
      if (values_.complaints.count() > before) return;  // the others would say the same
    }
  }

  const CpuModel* read_cpu(const YamlNode& map) {
    const std::string name = values_.optional_text(map, "cpu").value_or("214");
    const CpuModel* const model = find_cpu(name);
    std::string known;
    for (const CpuModel* each : all_cpus()) known.append(known.empty() ? "" : ", ").append(each->name);
    if (!model)
      values_.wrong(*map.find("cpu"), fmt::format("there is no model of CPU '{}'", stl::shortened(name)),
                    "modelled: " + known);
    return model;
  }

  /// The files of a project as one text, read once. Nothing after a complaint.
  std::optional<SourceText> read_project(const Named& plc) {
    const YamlNode* const program = plc.item.find("program");
    if (!program) {
      values_.wrong(plc.key, fmt::format("PLC '{}' has no program", plc.key.text), "write for example program: slave.stl");
      return {};
    }
    std::vector<const YamlNode*> nodes{program};
    for (const YamlNode* part : list(plc.item, "with", "symbols.txt")) nodes.push_back(part);
    std::vector<SourceText> files;
    for (const YamlNode* node : nodes) {
      const auto written = values_.text(*node);
      if (!written) return {};
      std::string why;
      const SourceText* const text = text_of(beside(path_, *written), why);
      if (!text) {
        values_.wrong(*node, fmt::format("cannot read {}: {}", beside(path_, *written), why));
        return {};
      }
      files.push_back(*text);
    }
    return join_files(std::move(files));
  }

  const SourceText* text_of(const std::string& path, std::string& why) {
    if (const auto known = texts_.find(path); known != texts_.end()) return &known->second;
    if (is_standard_input(path)) why = "a system names its files";
    const auto bytes = is_standard_input(path) ? std::nullopt : read_file(path, why);
    auto text = bytes ? read_source(*bytes, path, why) : std::nullopt;
    return text ? &texts_.emplace(path, std::move(*text)).first->second : nullptr;
  }

  std::shared_ptr<const Program> read_program(const Named& plc, const CpuModel& model, std::optional<std::int64_t> station) {
    const YamlNode& map = plc.item;
    auto project = read_project(plc);
    if (!project) return nullptr;
    stl::Source& source = project->parsed.source;
    if (!repair_slips(map, source)) return nullptr;
    if (station && !set_constant(source, kStationByte, {.value = *station}, true))
      values_.wrong(*map.find("station"), fmt::format("the program moves no constant into {}", kStationByte),
                    "'constants' sets another place: constants: {VB10: 5}");
    set_constants(map, source);
    const auto times = read_times(map, model);
    if (!times) return nullptr;
    CheckResult result = check(std::move(project->parsed), model, *times);
    if (result.program) return with_ppi_rates_of(map, std::move(result.program));
    std::erase_if(result.diagnostics, [](const auto& d) { return d.severity == stl::Severity::Warning; });
    values_.wrong(*map.find("program"), fmt::format("{} has errors", result.source.name));
    file_.programs.push_back({std::make_shared<stl::SourceLines>(std::move(result.source)), std::move(result.diagnostics)});
    return nullptr;
  }

  bool repair_slips(const YamlNode& map, stl::Source& source) {
    const auto written = values_.optional_text(map, "repair");
    if (!written) return true;
    std::string why;
    std::vector<std::string> unknown;
    const Repairs repairs = parse_repairs(*written, why);
    if (why.empty()) repair(source, repairs, unknown);
    if (!unknown.empty()) why = fmt::format("the listing has no slip {}", unknown.front());
    if (!why.empty()) values_.wrong(*map.find("repair"), why, "`s7200 check` names the slips of a listing that is known");
    return why.empty();
  }

  std::optional<TimeTable> read_times(const YamlNode& map, const CpuModel& model) {
    const auto written = values_.optional_text(map, "times");
    std::vector<std::string> errors;
    auto times = load_times(model, !written ? "" : find_times(*written) ? *written : beside(path_, *written), errors);
    if (!times) values_.wrong(*map.find("times"), errors.empty() ? "no such table" : errors.front());
    return times;
  }

  std::shared_ptr<const Program> with_ppi_rates_of(const YamlNode& map, std::shared_ptr<const Program> program) {
    const auto written = values_.optional_text(map, "ppi_baud");
    if (!written) return program;
    std::string why;
    const auto rates = parse_ppi_rates(*written, *program->model, why);
    if (!rates) values_.wrong(*map.find("ppi_baud"), why);
    return rates ? with_ppi_rates(*program, *rates) : nullptr;
  }

  void set_constants(const YamlNode& map, stl::Source& source) {
    const YamlNode* const constants = map.find("constants");
    if (!constants) return;
    if (!constants->is_map())
      return values_.wrong(*constants, "'constants' is a map, not " + to_text(*constants),
                           "write for example {SMB30: 16#45}");
    for (std::size_t i = 0; i < constants->keys.size(); ++i) {
      const auto value = values_.number(&constants->items[i], INT32_MIN, UINT32_MAX);
      const auto form = constants->items[i].text.starts_with("16#") ? stl::Integer::Form::Hex : stl::Integer::Form::Decimal;
      if (value && !set_constant(source, constants->keys[i].text, {.value = *value, .form = form}, false))
        values_.wrong(constants->keys[i],
                      fmt::format("the program moves no constant to {}", stl::shortened(constants->keys[i].text)),
                      "MOVB, MOVW or MOVD with a constant and that address would");
    }
  }

  void read_settings(const YamlNode& map, PlcPlan& plc, bool one_of_several) {
    PlcSettings& settings = plc.settings;
    if (const YamlNode* set = map.find("set")) settings.set = assignments(*set, *plc.program);
    settings.input = path(map, "input");
    read_inputs(map, plc);
    if (const YamlNode* clock = map.find("clock"))
      settings.clock = values_.value(clock, "a time from 1990 to 2089", "2026-11-21 10:00:00",
                                     [](const std::string& t) { return parse_clock(t); });
    settings.memory.path = written_file(map, "memory", one_of_several);
    settings.trace = written_file(map, "trace", one_of_several);
    settings.output = written_file(map, "output", one_of_several);
    const bool instructions = values_.truth(map.find("trace_instructions"));
    if (instructions) settings.trace_detail = TraceDetail::Instructions;
    if (instructions && settings.trace.empty())
      values_.wrong(*map.find("trace_instructions"), "there is no 'trace' to write them to");
    for (const YamlNode* item : list(map, "dump", "VB0:16, VW100")) {
      const auto text = values_.text(*item);
      std::string why;
      const auto range = text ? parse_range(*text, *plc.program, why) : std::nullopt;
      if (text && !range) values_.wrong(*item, why);
      if (!range) continue;
      settings.dumps.push_back(*range);
      settings.dump_names.push_back(*text);
    }
  }

  std::vector<Assignment> assignments(const YamlNode& set, const Program& program) {
    std::vector<Assignment> all;
    if (!set.is_map()) {
      values_.wrong(set, "'set' is a map, not " + to_text(set), "write for example set: {VW20: 5, I0.3: 1}");
      return {};
    }
    for (std::size_t i = 0; i < set.keys.size(); ++i) {
      const auto value = values_.text(set.items[i]);
      std::string why;
      const auto assignment =
          value ? parse_assignment(fmt::format("{}={}", set.keys[i].text, *value), program, why) : std::nullopt;
      if (assignment)
        all.push_back(*assignment);
      else if (value)
        values_.wrong(set.keys[i], why);
    }
    return all;
  }

  void read_inputs(const YamlNode& map, PlcPlan& plc) {
    std::vector<std::string> problems;
    auto field = read_field(plc.settings.input, *plc.program->model, problems);
    if (field)
      plc.field = std::move(*field);
    else
      values_.wrong(*map.find("input"), problems.front(),
                    problems.size() > 1 ? fmt::format("and {} more", problems.size() - 1) : "");
  }

  /// A file that is written has one writer.
  std::string written_file(const YamlNode& map, std::string_view key, bool one_of_several) {
    const YamlNode* const node = map.find(key);
    const std::string path = this->path(map, key);
    if (path.empty()) return path;
    if (one_of_several) {
      values_.wrong(*node, fmt::format("several copies cannot write one file: {}", path),
                    "name the PLC apart from its copies");
      return "";
    }
    take_file(*node, path);
    return path;
  }

  void take_file(const YamlNode& node, const std::string& path) {
    const auto [known, is_new] = written_.emplace(path, node.position.line);
    if (!is_new)
      values_.wrong(node, fmt::format("{} is written twice, first in line {}", path, known->second),
                    "give each a name of its own");
  }

  // --- peers ---

  void read_peer(const Named& peer) {
    const YamlNode& map = peer.item;
    const bool master = map.find("polls") != nullptr, other = map.find("westinghouse") != nullptr;
    if (master && other)
      check_keys(map, {Where::OtherPlc, Where::Master});
    else
      check_keys(map, {other ? Where::OtherPlc : Where::Master});
    if (master == other)
      values_.wrong(peer.key,
                    fmt::format("'{}' is {} a master {} another PLC", stl::shortened(peer.key.text),
                                master ? "both" : "neither", master ? "and" : "nor"),
                    "a master has 'polls', a PLC of another make 'westinghouse'");
    if (!take_station(peer.key, peer.key.text)) return;
    others_[peer.key.text] = {&peer.key, {StationPlan::Kind::Peer, plan().peers.size(), 0}};
    PeerPlan& plan = this->plan().peers.emplace_back();
    plan.name = peer.key.text;
    if (master) read_polls(map, plan.polls);
    if (other && !master) plan.automaton = read_other_plc(map, plan.sync);
  }

  void read_polls(const YamlNode& map, serial::PollPlan& polls) {
    polls.every = values_.duration(map.find("every")).value_or(0);
    const Time timeout = values_.duration(map.find("timeout")).value_or(kSecond);
    for (const YamlNode* poll : list(map, "polls", "{station: 1..3, read: 40001, count: 10}")) {
      if (!poll->is_map()) {
        values_.wrong(*poll, "what is polled is a map, not " + to_text(*poll),
                      "write for example {station: 1, read: 40001}");
        continue;
      }
      check_keys(*poll, {Where::Poll});
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
    std::string why;
    const auto address = text ? modbus::parse_address(*text, why) : std::nullopt;
    if (text && !address) values_.wrong(node, why);
    return address;
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
    const auto value = values_.number(poll.find("value"), 0, 0xFFFF);
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
      std::string known;
      for (const westinghouse::PlcRow& each : westinghouse::plcs())
        known.append(known.empty() ? "" : ", ").append(each.name);
      if (name)
        values_.wrong(protocol, fmt::format("there is no protocol '{}'", stl::shortened(*name)), "there are " + known);
      return nullptr;
    }
    std::string why;
    const std::size_t before = values_.complaints.count();
    const std::string model = values_.optional_text(map, "model").value_or(std::string(row->models.front()));
    std::shared_ptr<westinghouse::Plc> plc = westinghouse::make_plc(*row, model, why);
    if (!plc) values_.wrong(*map.find("model"), why);
    for (const YamlNode* setting : list(map, "settings", "unit=05")) {
      const auto text = values_.text(*setting);
      if (plc && text && !plc->set(*text, why)) values_.wrong(*setting, why);
    }
    if (!plc || values_.complaints.count() > before) return plc;
    const YamlNode* const wire = map.find("sync");
    if (wire && !plc->needs_sync())
      values_.wrong(*wire, "this PLC has no sync signal, or ignores it", "the PC1000 LAN with sync=required has one");
    else if (wire)
      sync = read_output(*wire);
    else if (plc->needs_sync())
      values_.wrong(protocol, "nothing drives the sync signal that this PLC needs to hear anything",
                    "write sync: gateway.Q0.0, or settings: [sync=ignored]");
    return plc;
  }

  /// `gateway.Q0.0`
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
    std::string why;
    const auto output = parse_range(written->substr(dot + 1), *plc->program, why);
    if (output && (output->area != Area::Q || output->width != Width::Bit || output->count != 1))
      why = fmt::format("'{}' is not an output point", stl::shortened(written->substr(dot + 1)));
    if (!why.empty()) {
      values_.wrong(node, why, kExample);
      return {};
    }
    return PeerPlan::Output{static_cast<std::size_t>(plc - plan().plcs.begin()), {output->number, output->bit}};
  }

  // --- bridges ---

  void read_bridge(const Named& bridge) {
    const YamlNode& map = bridge.item;
    check_keys(map, {Where::Bridge});
    if (!take_station(bridge.key, bridge.key.text)) return;
    if (map.keys.size() != 1)
      return values_.wrong(bridge.key, fmt::format("'{}' is not one kind of bridge", bridge.key.text),
                           "write for example {tcp: 5020}");
    BridgePlan plan{bridge.key.text, map.keys[0].text, values_.text(map.items[0]).value_or("")};
    if (plan.kind == "pty") plan.where = beside(path_, plan.where);
    if (const std::string place = place_of(plan, map.items[0]); !place.empty()) {
      const auto [known, is_new] = served_.emplace(place, bridge.key.position.line);
      if (!is_new)
        values_.wrong(map.items[0], fmt::format("two bridges at {}, the first in line {}", plan.where, known->second));
    }
    others_[plan.name] = {&bridge.key, {StationPlan::Kind::Bridge, this->plan().bridges.size(), 0}};
    this->plan().bridges.push_back(std::move(plan));
  }

  /// What only one bridge can have: a link, a device, a port of an address. Empty for a port that is free then, and after a
  /// complaint.
  std::string place_of(const BridgePlan& bridge, const YamlNode& where) {
    if (bridge.kind == "pty" || bridge.kind == "device") return bridge.where;
    std::string why;
    const auto address = parse_listen_address(bridge.where, why);
    if (!address) values_.wrong(where, why, "write for example 5020 or 0.0.0.0:5020");
    return address && address->port != 0 ? to_text(*address) : "";
  }

  // --- lines ---

  void read_line(const Named& line) {
    const YamlNode& map = line.item;
    check_keys(map, {Where::Line});
    LinePlan& plan = this->plan().lines.emplace_back();
    plan.name = line.key.text;
    if (std::ranges::find(this->plan().plcs, plan.name, &PlcPlan::name) != this->plan().plcs.end())
      values_.wrong(line.key, fmt::format("a PLC is called '{}' too", stl::shortened(plan.name)),
                    "give the line a name of its own: --at and 'on' take either");
    if (const auto baud = values_.number(map.find("baud"), 50, 1'000'000))
      plan.settings.baud = static_cast<std::uint32_t>(*baud);
    plan.settings.parity =
        values_.choice<Parity>(map.find("parity"), {{"none", Parity::None}, {"even", Parity::Even}, {"odd", Parity::Odd}});
    if (const auto bits = values_.number(map.find("data_bits"), 7, 8))
      plan.settings.data_bits = static_cast<std::uint8_t>(*bits);
    if (const auto bits = values_.number(map.find("stop_bits"), 1, 2))
      plan.settings.stop_bits = static_cast<std::uint8_t>(*bits);
    if (const auto seed = values_.number(map.find("contention"), 0, UINT32_MAX))
      plan.contention = static_cast<std::uint64_t>(*seed);
    for (const YamlNode* item : list(map, "capture", "bus.pcap"))
      if (const auto written = values_.text(*item)) {
        plan.captures.push_back(beside(path_, *written));
        take_file(*item, plan.captures.back());
      }
    for (const YamlNode* item : list(map, "stations", "master, slave")) read_station(*item, plan);
    read_faults(map, plan);
    if (plan.stations.empty() && values_.complaints.count() == 0)
      values_.wrong(line.key, fmt::format("no one is on line '{}'", line.key.text), "name them: stations: [master, slave]");
    if (!plan.captures.empty() && values_.complaints.count() == 0 && !first_plc(plan) &&
        !first_other_plc(this->plan(), plan))
      values_.wrong(*map.find("capture"), fmt::format("no PLC is on line '{}': rx and tx are those of one", line.key.text));
    if (plan.stations.size() > static_cast<std::size_t>(serial::Line::kDrivers))
      values_.wrong(*map.find("stations"),
                    fmt::format("{} stations: a line takes {}", plan.stations.size(), serial::Line::kDrivers),
                    "more need a repeater; a second line and a gateway with two ports do it too");
    read_turn_round(map, plan);
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
    for (const YamlNode* item : list(map, "faults", "\"noise:ber=1e-5\"")) {
      if (item->is_map()) check_keys(*item, {Where::Fault});
      const YamlNode* const what = item->is_map() ? item->find("fault") : item;
      if (!what)
        values_.wrong(*item, "a fault of a station without the 'fault' itself",
                      "write for example {fault: parity, station: slave}");
      else if (const auto fault = read_fault(*what, item->find("station"), line))
        line.faults.push_back(*fault);
    }
  }

  /// `station`: what stands beside the fault to say whose it is, or null.
  std::optional<FaultPlan> read_fault(const YamlNode& what, const YamlNode* station, const LinePlan& line) {
    const auto text = values_.text(what);
    if (!text) return {};
    const serial::ParsedFault parsed = serial::parse_fault(*text);
    if (parsed.error) values_.wrong(what, parsed.error->message, "`s7200 run --help` has the kinds of faults");
    const auto place = station ? station_on(line, *station) : std::nullopt;
    if (parsed.error || (station && !place)) return {};
    if (place && !may_be_of(line.stations[*place], parsed.fault, what, *station)) return {};
    return FaultPlan{parsed.fault, place};
  }

  /// False after a complaint.
  bool may_be_of(const StationPlan& station, const serial::Fault& fault, const YamlNode& what, const YamlNode& name) {
    if (!serial::is_of_a_station(fault))
      values_.wrong(name, "noise, and a fault at an instant, are of the line and not of a station");
    else if (fault.of != serial::Half::Request || fault.station != serial::Station::Master)
      values_.wrong(what, "the fault says whose it is, and so does 'station' beside it", "leave 'of=' or 'station=' out");
    else if (fault.kind == serial::FaultKind::Echo && station.kind == StationPlan::Kind::Plc)
      values_.wrong(name, "the port of an S7-200 does not hear what it sends", "an echo is of a peer or a bridge");
    else
      return true;
    return false;
  }

  /// The number of a station among those of its line: `slave2`, `gateway.1`.
  std::optional<std::size_t> station_on(const LinePlan& line, const YamlNode& node) {
    const auto name = values_.text(node);
    if (!name) return {};
    std::string known;
    for (std::size_t i = 0; i < line.stations.size(); ++i) {
      const std::string& each = name_of(plan(), line.stations[i]);
      if (each == *name || fmt::format("{}.{}", each, line.stations[i].port) == *name) return i;
      known.append(known.empty() ? "" : ", ").append(each);
    }
    values_.wrong(node, fmt::format("'{}' is not on line '{}'", stl::shortened(*name), line.name), "known: " + known);
    return {};
  }

  // --- events ---

  void read_event(const YamlNode& node) {
    if (!node.is_map()) return values_.wrong(node, "an event is a map, not " + to_text(node), std::string(kEventExample));
    check_keys(node, {Where::Event});
    auto event = read_what(node);
    if (!event) return;
    if (!node.find("at")) return values_.wrong(node, "an event without 'at'", std::string(kEventExample));
    event->at = values_.duration(node.find("at")).value_or(0);
    plan().events.push_back(std::move(*event));
  }

  /// What belongs beside another word has no place here. False after a complaint.
  bool only_its_own_beside(const YamlNode& node, const EventWord& word) {
    for (const YamlNode& key : node.keys) {
      const auto belongs_to = [&](const EventWord& w) { return std::ranges::find(w.beside, key.text) != w.beside.end(); };
      if (belongs_to(word) || std::ranges::none_of(event_words(), belongs_to)) continue;
      const EventWord& other = *std::ranges::find_if(event_words(), belongs_to);
      values_.wrong(key, fmt::format("'{}' has no place beside '{}'", key.text, word.word),
                    fmt::format("it belongs beside '{}'", other.word));
      return false;
    }
    return true;
  }

  static constexpr std::string_view kEventExample = "write for example {at: 1s, power_off: slave}";

  /// What it is done to. False after a complaint.
  bool read_object(const YamlNode& node, const YamlNode& what, EventPlan& event) {
    using What = EventPlan::What;
    if (event.what == What::Fault) return read_fault_event(node, what, event);
    if (event.what == What::Set) return read_set_event(node, what, event);
    if (event.what == What::PowerOff || event.what == What::PowerOn) return read_powered(what, event);
    const auto line = line_named(what);
    if (!line) return false;
    event.line = *line;
    return event.what != What::Cut || read_cut(node, event);
  }

  bool read_powered(const YamlNode& what, EventPlan& event) {
    const auto name = values_.text(what);
    if (!name) return false;
    const auto peer = std::ranges::find(plan().peers, *name, &PeerPlan::name);
    if (peer != plan().peers.end()) {
      event.station = {StationPlan::Kind::Peer, static_cast<std::size_t>(peer - plan().peers.begin())};
      return true;
    }
    if (std::ranges::find(plan().bridges, *name, &BridgePlan::name) != plan().bridges.end()) {
      values_.wrong(what, fmt::format("'{}' is a bridge, which has no power to switch", *name), "cut the cable before it");
      return false;
    }
    const auto plc = plc_named(what);
    if (plc) event.station = {StationPlan::Kind::Plc, *plc};
    return plc.has_value();
  }

  bool read_fault_event(const YamlNode& node, const YamlNode& what, EventPlan& event) {
    const YamlNode* const line = node.find("line");
    if (!line) values_.wrong(node, "a fault without its 'line'");
    const auto number = line ? line_named(*line) : std::nullopt;
    const auto fault = number ? read_fault(what, node.find("station"), plan().lines[*number]) : std::nullopt;
    if (!fault) return false;
    event.line = *number;
    event.fault = *fault;
    return true;
  }

  bool read_set_event(const YamlNode& node, const YamlNode& what, EventPlan& event) {
    const YamlNode* const name = node.find("plc");
    if (!name) values_.wrong(node, "'set' without the 'plc' whose memory it is");
    const auto number = name ? plc_named(*name) : std::nullopt;
    if (!number) return false;
    event.plc = *number;
    event.set = assignments(what, *plan().plcs[*number].program);
    return true;
  }

  bool read_cut(const YamlNode& node, EventPlan& event) {
    const YamlNode* const after = node.find("after");
    const auto name = after ? values_.text(*after) : std::nullopt;
    if (!after) values_.wrong(node, "a cut without 'after', the last station on the first part");
    if (!name) return false;
    const std::vector<StationPlan>& stations = plan().lines[event.line].stations;
    for (std::size_t i = 0; i < stations.size(); ++i)
      if (name_of(plan(), stations[i]) == *name) event.near = i + 1;
    if (event.near == 0 || event.near == stations.size()) {
      values_.wrong(
          *after,
          fmt::format("'{}' is not on line '{}', or its last station", stl::shortened(*name), plan().lines[event.line].name),
          "the cable is cut after one of the others");
      return false;
    }
    return true;
  }

  template <class Plans>
  std::optional<std::size_t> named(const YamlNode& node, const Plans& plans, std::string_view what) {
    const auto name = values_.text(node);
    if (!name) return {};
    std::string known;
    for (std::size_t i = 0; i < plans.size(); ++i) {
      if (plans[i].name == *name) return i;
      known.append(known.empty() ? "" : ", ").append(plans[i].name);
    }
    values_.wrong(node, fmt::format("there is no {} '{}'", what, stl::shortened(*name)), "known: " + known);
    return {};
  }
  /// Of a PLC one port is enough.
  void check_all_are_on_lines() {
    const auto check = [&](const YamlNode& key, const std::string& name, bool on_a_line) {
      if (!on_a_line) values_.wrong(key, fmt::format("'{}' is on no line", name), "name it in the 'stations' of one");
    };
    for (std::size_t plc = 0; plc < plan().plcs.size(); ++plc)
      check(*plc_keys_[plc], plan().plcs[plc].name,
            on_a_line({StationPlan::Kind::Plc, plc, 0}) || on_a_line({StationPlan::Kind::Plc, plc, 1}));
    for (const auto& [name, station] : others_) check(*station.key, name, on_a_line(station.plan));
  }

  std::optional<std::size_t> plc_named(const YamlNode& node) { return named(node, plan().plcs, "PLC"); }
  std::optional<std::size_t> line_named(const YamlNode& node) { return named(node, plan().lines, "line"); }

  bool on_a_line(const StationPlan& station) {
    return std::ranges::any_of(plan().lines, [&](const LinePlan& line) {
      return std::ranges::any_of(line.stations, [&](const StationPlan& s) {
        return s.kind == station.kind && s.number == station.number && s.port == station.port;
      });
    });
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
    if (const auto other = others_.find(name); other != others_.end()) {
      if (dot != std::string::npos)
        return values_.wrong(node, fmt::format("'{}' has one port only", name), "leave the number out");
      return put_on(node, line, other->second.plan, name);
    }
    const auto group = groups_.find(name);
    if (group != groups_.end()) {
      for (const std::size_t plc : group->second) put_plc_on(node, line, plc, *port);
      return;
    }
    for (std::size_t i = 0; i < plan().plcs.size(); ++i)
      if (plan().plcs[i].name == name) return put_plc_on(node, line, i, *port);
    values_.wrong(node, fmt::format("there is no station '{}'", stl::shortened(name)), "known: " + known_stations());
  }

  std::string known_stations() {
    std::string known;
    for (const auto& [name, plcs] : groups_) known.append(known.empty() ? "" : ", ").append(name);
    for (const auto& [name, other] : others_) known.append(known.empty() ? "" : ", ").append(name);
    return known.empty() ? "none; 'plcs' and 'peers' name them" : known;
  }

  void put_plc_on(const YamlNode& node, LinePlan& line, std::size_t number, std::uint8_t port) {
    const PlcPlan& plc = plan().plcs[number];
    if (!plc.program) return;
    const CpuModel& model = *plc.program->model;
    if (port >= model.ports)
      return values_.wrong(node, fmt::format("CPU {} has no port {}", model.name, port),
                           fmt::format("a second port needs {}", s7200::to_text(kTwoPorts)));
    put_on(node, line, {StationPlan::Kind::Plc, number, port}, plc.name);
  }

  void put_on(const YamlNode& node, LinePlan& line, const StationPlan& station, const std::string& name) {
    if (!on_a_line(station)) return line.stations.push_back(station);
    const std::string port = station.kind == StationPlan::Kind::Plc ? fmt::format("port {} of ", station.port) : "";
    values_.wrong(node, fmt::format("{}'{}' is on a line already", port, name), "a port is on one line, and there once");
  }

  SystemFile& file_;
  const std::string& path_;
  YamlValues& values_;
  std::map<std::string, SourceText> texts_{};                 // by path
  std::map<std::string, std::uint32_t> names_{}, written_{};  // and the line where they stand
  std::size_t stations_ = 0;
  std::map<std::string, std::vector<std::size_t>> groups_{};  // PLCs by the name in the file
  std::vector<const YamlNode*> plc_keys_{};                   // by number
  struct Other {
    const YamlNode* key;
    StationPlan plan;
  };
  std::map<std::string, Other> others_{};          // peers and bridges
  std::map<std::string, std::uint32_t> served_{};  // where bridges are, and the line that says so
};

}  // namespace

std::span<const EventWord> event_words() {
  using What = EventPlan::What;
  static const std::vector<EventWord> kWords{{"power_off", What::PowerOff},      {"power_on", What::PowerOn},
                                             {"cut", What::Cut, {"after"}},      {"mend", What::Mend},
                                             {"set", What::Set, {"plc"}},        {"fault", What::Fault, {"line", "station"}},
                                             {"clear_faults", What::ClearFaults}};
  return kWords;
}

const EventWord& word_of(EventPlan::What what) { return *std::ranges::find(event_words(), what, &EventWord::what); }

bool is_system_file(std::string_view path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  return extension == ".yaml" || extension == ".yml";
}

SystemFile read_system(const std::string& text, const std::string& path) {
  SystemFile file;
  file.file.source = source_of(text, path);
  stl::Diagnostics& diagnostics = file.file.diagnostics;
  const auto root = read_yaml(text, *file.file.source, diagnostics, {"a system file", "'plcs:' and 'lines:'"});
  YamlValues values(diagnostics);
  if (root) Reader(file, path, values).read(*root);
  stl::sort(diagnostics);
  return file;
}

std::optional<EventPlan> read_event(const YamlNode& node, const SystemPlan& plan, YamlValues& values) {
  SystemFile file{.plan = plan, .file = {}, .programs = {}};
  return Reader(file, "", values).read_what(node);
}

}  // namespace s7200::tools
