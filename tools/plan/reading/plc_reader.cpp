#include "tools/plan/reading/plc_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/base/ppi_frame.hpp"
#include "interpreter/base/result.hpp"
#include "interpreter/base/text/joined.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/model/times/named_times.hpp"
#include "interpreter/program/load.hpp"
#include "interpreter/program/loading/load_times.hpp"
#include "interpreter/program/loading/slips.hpp"
#include "interpreter/program/operands/constants.hpp"
#include "serial_sim/line/line.hpp"
#include "serial_sim/modbus/functions.hpp"
#include "tools/plan/program_cpu.hpp"
#include "tools/plan/reading/plc_key_reader.hpp"
#include "tools/yaml/names.hpp"

namespace s7200::tools {
namespace {

using Where = SystemKey::Where;

constexpr std::int64_t kMostCopies = serial::Line::kDrivers;

/// The byte where our Modbus slaves and Application Tip 41 keep their station address.
constexpr std::string_view kStationByte = "VB4095";

class PlcReader {
 public:
  explicit PlcReader(SystemReading& reading) : reading_(reading) {}

  void read(const Named& plc) {
    const YamlNode& map = plc.item;
    check_keys(map, {Where::Plc}, values_);
    const CpuModel* const model = read_cpu(plc);
    const std::int64_t copies = values_.number(map.find("copies"), 1, kMostCopies).value_or(1);
    const bool numbered = map.find("copies") != nullptr;
    const auto station = values_.number(map.find("station"), 1, modbus::kLastStation - (copies - 1));
    SystemBlock block = model ? read_block(map, *model, copies) : SystemBlock{};
    const std::size_t before = values_.complaints.count();
    std::vector<std::size_t>& those = names_.groups[plc.key.text];
    if (numbered) names_.take_name(plc.key, plc.key.text, values_);
    for (std::int64_t copy = 0; copy < copies; ++copy) {
      const std::string name = numbered ? fmt::format("{}{}", plc.key.text, copy + 1) : plc.key.text;
      if (!names_.take_station(plc.key, name, values_)) return;
      those.push_back(plan().plcs.size());
      names_.plc_keys.push_back(&plc.key);
      names_.modbus_stations.emplace_back();
      PlcPlan& each = plan().plcs.emplace_back();
      each.name = name;
      if (station) each.address = static_cast<std::uint8_t>(*station + copy);
      if (!model || values_.complaints.count() > before) continue;  // the other copies would say the same
      each.program = read_program(plc, *model, station ? std::optional(*station + copy) : std::nullopt);
      each.settings.system_block = block;
      if (each.program) each.program = with_system_block(*each.program, block);
      if (each.program) read_settings(map, each, copy, copies > 1);
      if (map.find("ppi_station"))
        for (std::uint8_t& ppi_station : block.ppi_stations) ++ppi_station;
    }
  }

 private:
  /// Reads the CPU in the key `cpu`, or finds it for the program. Null after a complaint.
  const CpuModel* read_cpu(const Named& plc) {
    const auto name = values_.optional_text(plc.item, "cpu");
    if (!name) return find_cpu_of(plc);
    const CpuModel* const model = find_cpu(*name);
    if (!model)
      values_.wrong(*plc.item.find("cpu"), fmt::format("there is no model of CPU '{}'", stl::shortened(*name)),
                    "modelled: " + stl::joined(all_cpus(), &CpuModel::name));
    return model;
  }

  const CpuModel* find_cpu_of(const Named& plc) {
    const auto project = read_project(plc);
    if (!project) return nullptr;
    const ProgramCpu found = cpu_of_program(*project, beside(reading_.path, plc.item.find("program")->text), reading_.files);
    if (!found.model) values_.wrong(*plc.item.find("program"), found.why);
    if (!found.note.empty())
      reading_.file.file.diagnostics.push_back({.severity = stl::Severity::Warning,
                                                .position = plc.key.position,
                                                .message = fmt::format("PLC '{}' names no CPU", plc.key.text),
                                                .hint = fmt::format("its program does not run on a CPU 214, so CPU {0} is "
                                                                    "assumed; write cpu: {0} if that is right",
                                                                    found.model->name)});
    return found.model;
  }

  /// The files of a project as one text, read once. Nothing after a complaint.
  std::optional<SourceText> read_project(const Named& plc) {
    const YamlNode* const program = plc.item.find("program");
    if (!program) {
      values_.wrong(plc.key, fmt::format("PLC '{}' has no program", plc.key.text), "write for example program: slave.stl");
      return {};
    }
    std::vector<const YamlNode*> nodes{program};
    for (const YamlNode* part : items_of(plc.item, "with", "symbols.txt", values_)) nodes.push_back(part);
    std::vector<SourceText> files;
    for (const YamlNode* node : nodes) {
      const auto written = name_from(*node, values_);
      if (!written) return {};
      const auto text = text_of(beside(reading_.path, *written));
      if (!text) {
        values_.wrong(*node, fmt::format("cannot read {}: {}", beside(reading_.path, *written), text.why()));
        return {};
      }
      files.push_back(*text);
    }
    SourceText project = join_files(std::move(files));
    for (const std::string& note : project.parsed.notes)
      if (told_.insert(note).second)
        reading_.notes.push_back({.severity = stl::Severity::Warning, .position = program->position, .message = note});
    return project;
  }

  Result<const SourceText&> text_of(const std::string& path) {
    if (const auto known = texts_.find(path); known != texts_.end()) return known->second;
    if (is_standard_input(path)) return Trouble{"a system names its files"};
    auto text = reading_.files.read(path).and_then([&](const std::string& bytes) { return read_source(bytes, path); });
    if (!text) return text.trouble();
    return texts_.emplace(path, *std::move(text)).first->second;
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
    if (station) check_station_is_set_once(map);
    set_constants(map, source);
    if (const auto known = constant_at(source, kStationByte); known && *known >= 1 && *known <= modbus::kLastStation)
      names_.modbus_stations.back() = static_cast<std::uint8_t>(*known);
    const auto times = read_times(map, model);
    if (!times) return nullptr;
    CheckResult result = check(std::move(project->parsed), model, *times);
    if (result.program) return result.program;
    std::erase_if(result.diagnostics, [](const auto& d) { return d.severity == stl::Severity::Warning; });
    values_.wrong(*map.find("program"), fmt::format("{} has errors", result.source.name));
    reading_.file.programs.push_back(
        {std::make_shared<stl::SourceLines>(std::move(result.source)), std::move(result.diagnostics)});
    return nullptr;
  }

  bool repair_slips(const YamlNode& map, stl::Source& source) {
    const auto written = values_.optional_text(map, "repair");
    if (!written) return true;
    std::vector<std::string> unknown;
    const auto repairs = parse_repairs(*written);
    if (repairs) repair(source, *repairs, unknown);
    if (repairs && unknown.empty()) return true;
    values_.wrong(*map.find("repair"), repairs ? fmt::format("the listing has no slip {}", unknown.front()) : repairs.why(),
                  "`s7200 check` names the slips of a listing that is known");
    return false;
  }

  std::optional<TimeTable> read_times(const YamlNode& map, const CpuModel& model) {
    const auto written = values_.optional_text(map, "times");
    std::vector<std::string> errors;
    auto times = load_times(model,
                            !written               ? ""
                            : find_times(*written) ? *written
                                                   : beside(reading_.path, *written),
                            reading_.files, errors);
    if (!times) values_.wrong(*map.find("times"), errors.empty() ? "no such table" : errors.front());
    return times;
  }

  /// Reads the system block of the first copy.
  SystemBlock read_block(const YamlNode& map, const CpuModel& model, std::int64_t copies) {
    PlcSettings settings;
    PlcKeyReader(values_, true, path_).read(map, PlcKey::Stage::Cpu, model, settings);
    const SystemBlock& block = settings.system_block;
    const std::int64_t last = *std::ranges::max_element(block.ppi_stations) + copies - 1;
    if (map.find("ppi_station") && last > ppi::kLastStation)
      values_.wrong(*map.find("ppi_station"),
                    fmt::format("the last copy would be PPI station {}; there are 1 to {}", last, ppi::kLastStation));
    return block;
  }

  void check_station_is_set_once(const YamlNode& map) {
    const YamlNode* const constants = map.find("constants");
    if (!constants || !constants->is_map()) return;
    for (const YamlNode& key : constants->keys)
      if (stl::upper_case(key.text) == kStationByte)
        values_.wrong(key, fmt::format("'station' and this both set {}", kStationByte), "leave one of them out");
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

  void read_settings(const YamlNode& map, PlcPlan& plc, std::int64_t copy, bool one_of_several) {
    const auto may_write = [this, one_of_several](const YamlNode& node, const std::string& path) {
      if (one_of_several)
        return values_.wrong(node, fmt::format("several copies cannot write one file: {}", path),
                             "name the PLC apart from its copies"),
               false;
      names_.take_file(node, path, values_);
      return true;
    };
    PlcKeyReader(values_, true, path_, may_write).read(map, PlcKey::Stage::Program, *plc.program, plc.settings);
    plc.settings.starts *= copy + 1;
    read_inputs(map, plc);
  }

  void read_inputs(const YamlNode& map, PlcPlan& plc) {
    std::vector<std::string> problems;
    auto field = read_field(plc.settings.input, *plc.program, reading_.files, problems);
    if (field)
      plc.field = std::move(*field);
    else
      values_.wrong(*map.find("input"), problems.front(),
                    problems.size() > 1 ? fmt::format("and {} more", problems.size() - 1) : "");
  }

  SystemPlan& plan() { return reading_.file.plan; }

  SystemReading& reading_;
  SystemNames& names_ = reading_.names;
  YamlValues& values_ = reading_.values;
  const PlcKeyReader::Path path_ = [this](const YamlNode& map, std::string_view key) {
    const auto written = values_.optional_text(map, key);
    return written ? beside(reading_.path, *written) : std::string();
  };
  std::map<std::string, SourceText> texts_{};  // by path
  std::set<std::string> told_{};               // notes on them; copies of a PLC share its files
};

}  // namespace

void read_plcs(const YamlNode& root, SystemReading& reading) {
  PlcReader reader(reading);
  for (const Named& each : entries(root, "plcs", reading.values)) reader.read(each);
}

}  // namespace s7200::tools
