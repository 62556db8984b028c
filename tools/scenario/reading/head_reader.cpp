#include "tools/scenario/reading/head_reader.hpp"

#include <algorithm>
#include <filesystem>

#include "interpreter/base/file_path.hpp"
#include "interpreter/base/text/joined.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "interpreter/model/times/named_times.hpp"
#include "interpreter/program/load.hpp"
#include "interpreter/program/loading/load_times.hpp"
#include "interpreter/program/loading/slips.hpp"
#include "serial_sim/modbus/functions.hpp"
#include "tools/host/files/files.hpp"
#include "tools/plan/program_cpu.hpp"
#include "tools/plan/reading/line_reader.hpp"
#include "tools/plan/reading/plc_key_reader.hpp"
#include "tools/plan/reading/system_reader.hpp"
#include "tools/scenario/reading/keys.hpp"
#include "tools/scenario/reading/memory_values.hpp"
#include "tools/yaml/names.hpp"

namespace s7200::tools {
namespace {

/// `95%`, above 0
std::optional<double> parse_share(const std::string& text) {
  if (!text.ends_with('%')) return {};
  const auto share = parse_decimal<double>(std::string_view(text).substr(0, text.size() - 1));
  return share && *share > 0 && *share <= 100 ? share : std::nullopt;
}

class HeadReader {
 public:
  HeadReader(ValueReader& values, const std::string& path, const GivenParameters* given)
      : values_(values), scenario_file_(path), given_(given) {}

  bool read(const YamlNode& map, Scenario& scenario) {
    if (const auto name = values_.optional_text(map, "name")) scenario.name = *name;
    const auto cpu = values_.optional_text(map, "cpu");
    if (cpu && !find_cpu(*cpu))
      values_.wrong(*map.find("cpu"), fmt::format("there is no model of CPU '{}'", stl::shortened(*cpu)),
                    "modelled: " + cpu_names());
    if (cpu && find_cpu(*cpu)) scenario.cpu = *cpu, scenario.cpu_named = true;
    read_rule(map, scenario.rule);
    if (const auto why = values_.optional_text(map, "expected_failure")) scenario.expected_failure = *why;
    std::string missing;
    if (!values_.has_what_it_needs(map, missing)) {
      scenario.skipped = "not applicable: " + missing;
      return false;
    }
    if (const auto path = optional_path(map, "program")) scenario.program = *path;
    if (const auto path = optional_path(map, "system")) read_plan(map, *path, scenario);
    if (const auto on = values_.optional_text(map, "on")) read_on(*map.find("on"), *on, scenario);
    if (const YamlNode* with = map.find("with")) read_parts(*with, scenario.with);
    read_symbols(scenario);
    if (!scenario.cpu_named && (map.find("program") || map.find("with"))) find_cpu_of_program(scenario);
    if (const auto repair = values_.optional_text(map, "repair")) {
      if (const auto repairs = parse_repairs(*repair); !repairs)
        values_.wrong(*map.find("repair"), repairs.why(), "`s7200 check` names the slips of a listing that is known");
      scenario.repair = *repair;
    }
    if (const auto path = optional_path(map, "skip_without")) {
      scenario.may_be_missing = *path == scenario.program;
      if (!std::filesystem::exists(file_path(*path))) scenario.skipped = *path + " is not there";
    }
    if (const auto times = values_.optional_text(map, "times")) {
      scenario.times = find_times(*times) ? *times : *optional_path(map, "times");
      check_times(*map.find("times"), scenario);
    }
    const auto path = [this](const YamlNode& of, std::string_view key) { return optional_path(of, key).value_or(""); };
    PlcKeyReader plc_keys(values_, false, path);
    plc_keys.read(map, PlcKey::Stage::Cpu, scenario.addresses(), scenario.plc);
    if (const YamlNode* port = map.find("port")) read_port(*port, scenario);
    if (const YamlNode* line = map.find("line")) read_line(*line, scenario.line);
    if (const auto station = read_station(map)) scenario.station = *station;
    if (const YamlNode* set = map.find("set")) scenario.plc.set = read_assignments(values_, *set, scenario.addresses());
    plc_keys.read(map, PlcKey::Stage::Program, scenario.addresses(), scenario.plc);
    if (const YamlNode* input = map.find("input")) read_inputs(*input, scenario);
    if (const auto after = values_.time(map.find("after"))) scenario.after = *after;
    if (const auto pause = values_.span(map.find("pause"))) scenario.pause = *pause;
    if (const auto timeout = values_.time(map.find("timeout"))) scenario.line.timeout = *timeout;
    if (const YamlNode* robust = map.find("robust")) {
      scenario.robust_at = robust->position;
      scenario.robust =
          values_.value(robust, "a share of the tables of execution times, above 0% and up to 100%", "95%", parse_share);
    }
    if (const auto tolerance = values_.time(map.find("tolerance"))) scenario.tolerance = *tolerance;
    return true;
  }

 private:
  void read_port(const YamlNode& node, Scenario& scenario) {
    const auto port = values_.number(&node, 0, 1);
    if (!port) return;
    if (*port >= find_cpu(scenario.cpu)->ports)
      values_.wrong(node, fmt::format("CPU {} has no port {}", scenario.cpu, *port),
                    "'cpu' names the CPU: 226 has two ports");
    else
      scenario.port = static_cast<std::uint8_t>(*port);
  }

  static std::string cpu_names() { return stl::joined(all_cpus(), &CpuModel::name); }

  /// A path from the folder of this file. One that was given from outside is from the folder of that file already.
  std::optional<std::string> optional_path(const YamlNode& map, std::string_view key) {
    const auto path = values_.optional_text(map, key);
    if (!path) return {};
    const bool given =
        given_ && given_->parameters.values.contains(key) && map.find(key)->text == fmt::format("${{{}}}", key);
    return given ? *path : beside(scenario_file_, *path);
  }

  void read_plan(const YamlNode& map, const std::string& path, Scenario& scenario) {
    const YamlNode& node = *map.find("system");
    for (const ScenarioKey& key : scenario_keys())
      if (const YamlNode* one = key.of == ScenarioKey::kOfOneProgram ? map.find(key.key) : nullptr)
        values_.wrong(*one, key.key == "robust"
                                ? "'robust' is of one program: a system is not run with other tables"
                                : fmt::format("'{}' is of one program: a system file says that of each PLC", key.key));
    const auto text = read_text(path);
    if (!text) return values_.wrong(node, fmt::format("cannot read {}: {}", path, text.why()));
    SystemFile file = read_system(*text, path, host_files());
    if (!file.ok()) {
      const stl::Diagnostic& first = file.file.diagnostics.front();
      return values_.wrong(node, fmt::format("{}:{}: {}", path, first.position.line, first.message),
                           fmt::format("'s7200 run {}' shows all that is wrong", path));
    }
    if (file.plan.plcs.empty() && !first_askable_line(file.plan))
      return values_.wrong(node, fmt::format("{} has no line with a PLC and room for a master", path),
                           "a scenario talks to PLCs");
    forget_files(file.plan);
    scenario.system = path;
    scenario.plan = std::make_shared<const SystemPlan>(std::move(file.plan));
  }

  static std::string why_no_place(const Scenario& scenario, const std::string& on) {
    return scenario.is_of_peers() ? find_line(*scenario.plan, on).why() : find_spot(*scenario.plan, on).why();
  }

  void read_on(const YamlNode& node, const std::string& on, Scenario& scenario) {
    if (!scenario.plan)
      values_.wrong(node, "'on' names a PLC or a line of a system", "name the file of one with 'system:'");
    else if (const std::string why = why_no_place(scenario, on); !why.empty())
      values_.wrong(node, why);
    scenario.on = on;
  }

  void read_parts(const YamlNode& parts, std::vector<std::string>& with) {
    if (!parts.is_list())
      return values_.wrong(parts, "'with' is a list of files, not " + to_text(parts),
                           "write for example with: [symbols.txt]");
    for (const YamlNode& part : parts.items)
      if (const auto path = name_from(part, values_)) with.push_back(beside(scenario_file_, *path));
  }

  /// What comes through a pipe is read with the program: it can be read only once.
  void check_times(const YamlNode& node, const Scenario& scenario) {
    std::error_code none;
    if (std::filesystem::is_fifo(file_path(scenario.times), none)) return;
    std::vector<std::string> errors;
    load_times(*find_cpu(scenario.cpu), scenario.times, host_files(), errors);
    for (const std::string& error : errors) values_.wrong(node, error);
  }

  /// A file that cannot be read is complained about when the program is.
  static void read_symbols(Scenario& scenario) {
    for (const std::string& path : scenario.with) {
      auto source = read_file(path).and_then([&](const std::string& bytes) { return read_source(bytes, path); });
      if (!source) continue;
      auto& symbols = source->parsed.source.symbols;
      scenario.symbols.insert(scenario.symbols.end(), symbols.begin(), symbols.end());
    }
  }

  /// As the program says, or its folder, or as it needs. A file that cannot be read is complained about when the program is.
  void find_cpu_of_program(Scenario& scenario) {
    std::vector<SourceText> files;
    std::vector<std::string> paths{scenario.program};
    paths.insert(paths.end(), scenario.with.begin(), scenario.with.end());
    for (const std::string& path : paths) {
      auto text = read_file(path).and_then([&](const std::string& bytes) { return read_source(bytes, path); });
      if (!text) return;
      files.push_back(std::move(*text));
    }
    const ProgramCpu found = cpu_of_program(join_files(std::move(files)), scenario.program, host_files());
    if (found.model) scenario.cpu = found.model->name;
    scenario.cpu_note = found.model ? found.note : found.why;
  }

  std::optional<std::uint8_t> read_station(const YamlNode& map) {
    constexpr std::uint8_t kServer = 255;  // of Modbus TCP, and not a station behind it
    return values_.value(
        map.find("station"),
        fmt::format("a station from 0 to {}, nor {}, a Modbus TCP server itself", modbus::kLastStation, kServer),
        fmt::format("1, {}", modbus::kLastStation), [](const std::string& t) -> std::optional<std::uint8_t> {
          const auto station = parse_integer(stl::trim(t));
          const bool known = station && *station >= 0 && (*station <= modbus::kLastStation || *station == kServer);
          return known ? std::optional(static_cast<std::uint8_t>(*station)) : std::nullopt;
        });
  }

  void read_rule(const YamlNode& map, Rule& rule) {
    if (const auto id = values_.optional_text(map, "rule")) rule.id = *id;
    if (const auto source = values_.optional_text(map, "source")) rule.source = *source;
    if (const auto severity = values_.choice<Rule::Severity>(
            map.find("severity"), {{"must", Rule::Severity::Must}, {"should", Rule::Severity::Should}}))
      rule.severity = *severity;
  }

  void read_line(const YamlNode& map, serial::MasterSettings& line) {
    if (!map.is_map())
      return values_.wrong(map, "'line' is a map, not " + to_text(map),
                           "write for example line: {baud: 19200, parity: none}");
    values_.check_keys(map, {ScenarioKey::Where::Line});
    read_line_settings(map, line, values_);
  }

  void read_inputs(const YamlNode& node, Scenario& scenario) {
    std::vector<std::string> problems;
    if (auto field = read_field(scenario.plc.input, scenario.addresses(), host_files(), problems))
      scenario.field = std::move(*field);
    else
      values_.wrong(node, problems.front(),
                    problems.size() > 1 ? fmt::format("and {} more mistakes in it", problems.size() - 1) : "");
  }

  ValueReader& values_;
  const std::string& scenario_file_;
  const GivenParameters* given_;
};

}  // namespace

bool read_head(ValueReader& values, const std::string& path, const GivenParameters* given, const YamlNode& map,
               Scenario& scenario) {
  return HeadReader(values, path, given).read(map, scenario);
}

}  // namespace s7200::tools
