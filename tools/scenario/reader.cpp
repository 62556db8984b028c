#include "tools/scenario/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <filesystem>
#include <limits>
#include <set>
#include <tuple>

#include "interpreter/base/bytes.hpp"
#include "interpreter/base/text.hpp"
#include "interpreter/program/load.hpp"
#include "serial_sim/modbus/address.hpp"
#include "tools/rig/clock_text.hpp"
#include "tools/scenario/yaml.hpp"
#include "tools/views/text_frame.hpp"

namespace s7200::tools {
namespace {

using Where = ScenarioKey::Where;

constexpr std::string_view kExchanges = "send request read write";
constexpr std::string_view kReceptions = "send request read write receive";

// clang-format off
const std::vector<ScenarioKey> kKeys{
    {Where::File, "scenarios", "", "LIST", "several scenarios; what stands beside it holds for all of them"},
    {Where::File, "parameters", "", "MAP", "names for `${…}` and their values, unless others are given on the command line; an empty one has to be"},

    {Where::Scenario, "name", "", "TEXT", "one line, for reports; the name of the file if left out"},
    {Where::Scenario, "program", "", "PATH", "STL file or published document, from the folder of this file, or `\"-\"` for standard input; `--target` comes before it"},
    {Where::Scenario, "skip_without", "", "PATH", "a file without which the scenario is skipped, such as a document that is not ours"},
    {Where::Scenario, "cpu", "", "TYPE", "`214` if left out"},
    {Where::Scenario, "times", "", "PATH", "execution times, CSV as of `s7200 times --csv`"},
    {Where::Scenario, "line", "", "MAP", "how the master talks, if not as the program has set its port"},
    {Where::Scenario, "station", "", "NUMBER", "address of the slave; 1 if left out"},
    {Where::Scenario, "set", "", "MAP", "memory and inputs before the first scan: `{VW20: 16#1234, I0.3: 1}`"},
    {Where::Scenario, "input", "", "PATH", "inputs over time, CSV as of `s7200 run --input`"},
    {Where::Scenario, "clock", "", "TIME", "time of day at the start: `2026-11-21 10:00:00`"},
    {Where::Scenario, "after", "", "TIME", "when the first step begins; if left out, when the first scan has ended and the line is quiet"},
    {Where::Scenario, "pause", "", "SPAN", "between an exchange and the next one; `7 characters + 10ms` if left out"},
    {Where::Scenario, "timeout", "", "TIME", "how long to wait for an answer or a transmission to begin, or for memory; `1s` if left out"},
    {Where::Scenario, "tolerance", "", "TIME", "by which a latency given as one figure may be missed; `0` if left out"},
    {Where::Scenario, "needs", "", "LIST", "calculations as inside `${…}`: if one is 0, or has a parameter without a value, the scenario is not applicable"},
    {Where::Scenario, "rule", "", "TEXT", "makes it a rule of a conformance suite, with this id"},
    {Where::Scenario, "source", "", "TEXT", "of a rule: the section it is from"},
    {Where::Scenario, "severity", "", "must, should", "of a rule; `must` if left out"},
    {Where::Scenario, "steps", "", "LIST", "what is done and expected, in this order"},

    {Where::Line, "baud", "", "NUMBER", "50 to 1000000"},
    {Where::Line, "parity", "", "none, even, odd", ""},
    {Where::Line, "data_bits", "", "7, 8", ""},
    {Where::Line, "stop_bits", "", "1, 2", ""},

    {Where::Action, "send", "", "HEX or {text: ASCII}", "a frame as it stands; `p` after a byte sends it with wrong parity"},
    {Where::Action, "request", "", "HEX", "function and data; station and CRC are added"},
    {Where::Action, "read", "", "AREA FIRST or NUMBER", "function 1, 2, 3 or 4: `coils 0`, `inputs 0`, `input-registers 0`, `holding 0`, counted from 0; or `00001`, `10001`, `30001`, `40001`, `400001`"},
    {Where::Action, "write", "", "AREA FIRST or NUMBER", "coils or holding registers: function 5 or 6 with `value`, 15 or 16 with `values`"},
    {Where::Action, "receive", "", "any, silence, HEX or {text: ASCII}", "a transmission that nobody asked for: the first since the last request, or the next to come"},
    {Where::Action, "wait", "", "SPAN or N scans", "nothing is sent for so long"},
    {Where::Action, "wait_until", "", "MAP", "goes on when memory is as in `memory`, looked at now, at the end of each scan, and when the time is over"},
    {Where::Action, "set", "", "MAP", "memory and inputs: `{VW20: 16#1234, I0.3: 1}`"},
    {Where::Action, "memory", "", "MAP", "what must be in memory: `{VW20: 16#1234, VW22: 5..10, Q0.0: 1, VD24: 1.5, VB0:4: 01 02 .. 04}`"},
    {Where::Action, "interrupts", "", "MAP", "how often since the last request began: `{INT 123: 7, event 10: 1..2, lost: 0}`"},
    {Where::Action, "mode", "", "run, stop", "what mode the CPU must be in"},
    {Where::Action, "fatal", "", "CODE or none", "the fatal error there must have been: `0003`"},
    {Where::Action, "errors", "", "MAP or none", "all run-time errors there must have been: `{0092: 3, 0006: 1..}`"},
    {Where::Action, "fault", "", "FAULT or none", "a fault of the line from now on, as of `--fault`; or none any more"},
    {Where::Action, "power_cycle", "", "memory kept, memory lost", "power off and on again, for a short or a long time"},
    {Where::Action, "repeat", "", "NUMBER", "the `steps` beside it, so many times"},
    {Where::Action, "for", "", "MAP", "the `steps` beside it for each value: `{function: [1, 2], count: 1..8, f: functions}`"},

    {Where::Modifier, "steps", "repeat for", "LIST", "what is repeated"},
    {Where::Modifier, "crc", "send receive", "true, false", "append the CRC to the frame, and look for it at the end of what comes; `false` if left out"},
    {Where::Modifier, "station", "request read write", "NUMBER", "instead of the scenario's"},
    {Where::Modifier, "count", "read", "NUMBER", "how many; 1 if left out"},
    {Where::Modifier, "value", "write", "NUMBER", "the one to write"},
    {Where::Modifier, "values", "write", "LIST", "those to write"},
    {Where::Modifier, "expect", kExchanges, "ANSWER", "how it must end; if left out, in any way"},
    {Where::Modifier, "expect_one_of", kExchanges, "LIST", "several ANSWERs, one of which is right"},
    {Where::Modifier, "disturbed", kReceptions, "true, false", "whether what comes has parity or framing errors; `false` if left out"},
    {Where::Modifier, "latency", kReceptions, "WINDOW", "from the end of the request to the start of the answer; of `receive` from the start of the step, 0 if the transmission began earlier"},
    {Where::Modifier, "answer_gap", kReceptions, "WINDOW", "every pause between two characters of what comes"},
    {Where::Modifier, "at", kExchanges, "TIME", "when the request begins, since power-up"},
    {Where::Modifier, "at", "receive", "WINDOW", "when the transmission begins, since power-up"},
    {Where::Modifier, "pause", kExchanges, "SPAN", "between the exchange before and this one"},
    {Where::Modifier, "gap", kExchanges, "SPAN", "between the characters of the request; 0 if left out"},
    {Where::Modifier, "listen", kReceptions, "SPAN", "the silence that ends what comes; `3.5 characters` if left out"},
    {Where::Modifier, "timeout", "send request read write receive wait_until", "TIME", "instead of the scenario's"},
    {Where::Modifier, "power_off", "power_cycle", "TIME", "how long power was off; 0 if left out. The clock goes on, unless the memory is lost"},
    {Where::Modifier, "needs", "", "LIST", "as of a scenario; if one does not hold, the step is left out"},
    {Where::Modifier, "note", "", "TEXT", "shown when the step fails"},
};
// clang-format on

bool has_word(std::string_view words, std::string_view word) {
  for (std::size_t at = 0; at <= words.size();) {
    const std::size_t end = std::min(words.find(' ', at), words.size());
    if (words.substr(at, end - at) == word) return true;
    at = end + 1;
  }
  return false;
}

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return stl::is_upper(c) ? static_cast<char>(c + 32) : c; });
  return text;
}

/// What goes wrong in one file. A mistake in a loop is made in every turn of it and told once.
class Complaints {
 public:
  void add(const YamlNode& node, std::string message, std::string hint = {}) {
    if (known_.emplace(node.position.line, node.position.column).second)
      list.push_back({stl::Severity::Error, node.position, std::move(message), std::move(hint)});
  }
  stl::Diagnostics list;

 private:
  std::set<std::pair<std::uint32_t, std::uint32_t>> known_;
};

// --- parameters ---

/// Takes over what a tree says: a.b for maps in maps.
class ParameterTree {
 public:
  ParameterTree(Parameters& parameters, std::vector<GivenParameters::Name>& names, Complaints& complaints)
      : parameters_(parameters), names_(names), complaints_(complaints) {}

  void read(const YamlNode& map, const std::string& prefix) {
    if (!map.is_map())
      return complaints_.add(map, "parameters are a map, not " + to_text(map), "write for example: station: 1");
    for (std::size_t i = 0; i < map.keys.size() && i < map.items.size(); ++i) read_one(map.keys[i], map.items[i], prefix);
  }

 private:
  void read_one(const YamlNode& key, const YamlNode& value, const std::string& prefix) {
    const std::string name = prefix + key.text;
    const auto fits = [](char c) { return stl::is_letter(c) || stl::is_digit(c) || c == '_'; };
    if (!std::all_of(key.text.begin(), key.text.end(), fits) || !stl::is_letter(key.text.front()))
      return complaints_.add(key, fmt::format("'{}' is no name of a parameter", stl::shortened(key.text)),
                             "letters, digits and _");
    if (value.is_map()) return read(value, name + ".");
    names_.push_back({name, key.position});
    if (value.is_scalar()) {
      if (value.text.empty()) {
        parameters_.empty.insert(name);
      } else {
        parameters_.values[name] = value.text;
      }
      return;
    }
    std::vector<std::string>& list = parameters_.lists[name];
    list.clear();
    for (const YamlNode& item : value.items) {
      if (!item.is_scalar()) return complaints_.add(item, "a list of parameters has plain values only");
      list.push_back(item.text);
      parameters_.values[name + "." + item.text] = "1";
    }
  }

  Parameters& parameters_;
  std::vector<GivenParameters::Name>& names_;
  Complaints& complaints_;
};

std::string beside(const std::string& folder, const std::string& path) {
  if (is_standard_input(path)) return path;
  return (std::filesystem::path(folder) / path).lexically_normal().string();
}

std::string folder_of(const std::string& path) { return std::filesystem::path(path).parent_path().string(); }

std::shared_ptr<const stl::SourceLines> source_of(const std::string& text, const std::string& path) {
  auto source = std::make_shared<stl::SourceLines>();
  source->name = path;
  source->text = stl::split_lines(text);
  return source;
}

// --- scenarios ---

class Reader {
 public:
  Reader(ScenarioFile& file, const std::string& path, const GivenParameters* given)
      : file_(file), folder_(folder_of(path)), given_(given) {}

  void read(const YamlNode& root) {
    if (!root.is_map())
      return wrong(root, "a file of scenarios is a map, not " + to_text(root),
                   "begin with 'name:', 'program:' and 'steps:'");
    check_keys(root, {Where::File, Where::Scenario});
    read_parameters(root);
    Scenario common;
    common.source = file_.source;
    common.position = root.position;
    common.name = std::filesystem::path(file_.source->name).stem().string();
    const bool applicable = read_head(root, common);
    const YamlNode* list = root.find("scenarios");
    const YamlNode* steps = root.find("steps");
    if (!list && !steps) return wrong(root, "neither 'steps' nor 'scenarios'", "a scenario has 'steps:', a list");
    if (steps) {
      if (list) return wrong(*steps, "both 'steps' and 'scenarios'", "steps stand inside each scenario of the list");
      if (applicable) read_all_steps(*steps, common);
      file_.scenarios.push_back(std::move(common));
      return;
    }
    if (!list->is_list()) return wrong(*list, "'scenarios' is a list, not " + to_text(*list), "begin each with '- name:'");
    if (list->items.empty()) return wrong(*list, "no scenarios: nothing would be tested", "begin each with '- name:'");
    for (const YamlNode& each : list->items) read_scenario(each, common);
  }

  Complaints complaints;

 private:
  static constexpr int kLargestLoop = 4096;
  static constexpr std::string_view kDuration = "duration of a day at most";

  void wrong(const YamlNode& node, std::string message, std::string hint = {}) {
    if (!loop_.empty()) message += fmt::format(" (with {})", loop_);
    complaints.add(node, std::move(message), std::move(hint));
  }

  // --- keys ---

  static bool belongs(const ScenarioKey& key, const std::vector<Where>& places, std::string_view action) {
    if (std::find(places.begin(), places.end(), key.where) == places.end()) return false;
    return key.where != Where::Modifier || key.of.empty() || has_word(key.of, action);
  }

  /// Complains about keys that have no place here.
  void check_keys(const YamlNode& map, const std::vector<Where>& places, std::string_view action = {}) {
    for (const YamlNode& key : map.keys) {
      if (key.text == action) continue;
      const auto fits = [&](const ScenarioKey& k) { return k.key == key.text && belongs(k, places, action); };
      if (std::any_of(kKeys.begin(), kKeys.end(), fits)) continue;
      std::string known;
      for (const ScenarioKey& k : kKeys)
        if (belongs(k, places, action)) known.append(known.empty() ? "" : ", ").append(k.key);
      const std::string here = action.empty() ? "here" : fmt::format("beside '{}'", action);
      wrong(key, fmt::format("'{}' has no place {}", stl::shortened(key.text), here), "known: " + known);
    }
  }

  // --- values ---

  /// A scalar with its `${…}` put in; nothing after a complaint.
  std::optional<std::string> text(const YamlNode& node) {
    if (!node.is_scalar()) {
      wrong(node, "one value is needed here, not " + to_text(node));
      return {};
    }
    std::string why;
    auto result = substitute(node.text, parameters_, why);
    if (!result) wrong(node, why, "parameters: " + parameter_names());
    return result;
  }

  std::string parameter_names() const {
    std::string names;
    for (const auto& [name, value] : parameters_.values) names.append(names.empty() ? "" : ", ").append(name);
    return names.empty() ? "there are none; 'parameters:' at the top of the file, or --with FILE, has them" : names;
  }

  /// What `parse` makes of the value, if it is there; `what` it is and an `example` for the complaint.
  template <class Parse>
  auto value(const YamlNode* node, std::string_view what, std::string_view example, Parse parse)
      -> decltype(parse(std::string())) {
    if (!node) return {};
    const auto written = text(*node);
    if (!written || (written->empty() && !node->text.empty())) return {};  // a parameter without a value: as if left out
    auto result = parse(*written);
    if (!result)
      wrong(*node, fmt::format("'{}' is no {}", stl::shortened(*written), what),
            fmt::format("write for example {}", example));
    return result;
  }

  std::optional<Time> time(const YamlNode* node) {
    return value(node, kDuration, "250ms, 2s, 0", [](const std::string& t) -> std::optional<Time> {
      const auto span = parse_span(t);
      return span && span->millicharacters == 0 ? std::optional(span->fixed) : std::nullopt;
    });
  }
  std::optional<Span> span(const YamlNode* node) {
    return value(node, kDuration, "20ms, 3.5 characters, 7 characters + 10ms",
                 [](const std::string& t) { return parse_span(t); });
  }
  std::optional<std::int64_t> number(const YamlNode* node, std::int64_t from, std::int64_t to) {
    return value(node, fmt::format("number from {} to {}", from, to), fmt::format("{}, 16#{:X}", to, to),
                 [&](const std::string& t) {
                   const auto parsed = parse_number(t);
                   return parsed && *parsed >= from && *parsed <= to ? parsed : std::nullopt;
                 });
  }
  template <class Value>
  std::optional<Value> choice(const YamlNode* node, const std::vector<std::pair<std::string_view, Value>>& choices) {
    std::string all;
    for (const auto& [name, is] : choices) all.append(all.empty() ? "" : ", ").append(name);
    return value(node, "choice here", all, [&](const std::string& t) -> std::optional<Value> {
      for (const auto& [name, is] : choices)
        if (lower_case(t) == name) return is;
      return {};
    });
  }

  // --- parameters ---

  void read_parameters(const YamlNode& root) {
    std::vector<GivenParameters::Name> declared;
    if (const YamlNode* node = root.find("parameters")) ParameterTree(parameters_, declared, complaints).read(*node, "");
    if (!given_) return;
    for (const GivenParameters::Name& given : given_->names) {
      if (std::any_of(declared.begin(), declared.end(), [&](const auto& d) { return d.name == given.name; })) continue;
      std::string known;
      for (const auto& d : declared) known.append(known.empty() ? "" : ", ").append(d.name);
      file_.given_diagnostics.push_back(
          {stl::Severity::Error, given.position,
           fmt::format("{} has no parameter '{}'", file_.source->name, stl::shortened(given.name)),
           known.empty() ? "it has none" : "known: " + known});
    }
    for (const auto& [name, list] : given_->parameters.lists) {
      for (const std::string& old : parameters_.lists[name]) parameters_.values.erase(name + "." + old);
      parameters_.lists[name] = list;
    }
    for (const auto& [name, is] : given_->parameters.values) {
      parameters_.values[name] = is;
      parameters_.empty.erase(name);
    }
  }

  /// False, and what is missing, when something needed is not there.
  bool has_what_it_needs(const YamlNode& map, std::string& missing) {
    const YamlNode* needs = map.find("needs");
    if (!needs) return true;
    if (!needs->is_list()) {
      wrong(*needs, "'needs' is a list, not " + to_text(*needs), "write for example needs: [coils.count]");
      return true;
    }
    for (const YamlNode& need : needs->items) {
      const auto written = text(need);
      if (!written) continue;
      std::string why;
      const auto holds_here = holds(*written, parameters_, why);
      if (!holds_here) wrong(need, why);
      if (!holds_here.value_or(true)) {
        missing = *written;
        return false;
      }
    }
    return true;
  }

  // --- the head ---

  void read_scenario(const YamlNode& node, const Scenario& common) {
    if (!node.is_map()) return wrong(node, "a scenario is a map, not " + to_text(node), "begin each with '- name:'");
    check_keys(node, {Where::Scenario});
    Scenario scenario = common;
    scenario.position = node.position;
    scenario.name = fmt::format("{}:{}", common.name, node.position.line);
    const std::int64_t station = station_;
    if (read_head(node, scenario)) {
      const YamlNode* steps = node.find("steps");
      if (!steps)
        wrong(node, "a scenario without 'steps'");
      else
        read_all_steps(*steps, scenario);
    }
    station_ = station;
    file_.scenarios.push_back(std::move(scenario));
  }

  /// False if the scenario is not applicable: then its steps may need values that are not there.
  bool read_head(const YamlNode& map, Scenario& scenario) {
    if (const auto name = optional_text(map, "name")) scenario.name = *name;
    if (const auto cpu = optional_text(map, "cpu")) {
      if (find_cpu(*cpu))
        scenario.cpu = *cpu;
      else
        wrong(*map.find("cpu"), fmt::format("there is no model of CPU '{}'", stl::shortened(*cpu)),
              "modelled: " + cpu_names());
    }
    read_rule(map, scenario.rule);
    std::string missing;
    if (!has_what_it_needs(map, missing)) {
      scenario.skipped = "not applicable: " + missing;
      return false;
    }
    if (const auto path = optional_path(map, "program")) scenario.program = *path;
    if (const auto path = optional_path(map, "skip_without")) {
      scenario.may_be_missing = *path == scenario.program;
      if (!std::filesystem::exists(*path)) scenario.skipped = *path + " is not there";
    }
    if (const auto path = optional_path(map, "times")) scenario.times_file = *path;
    if (const YamlNode* line = map.find("line")) read_line(*line, scenario.line);
    if (const auto station = number(map.find("station"), 0, 255)) station_ = *station;
    if (const YamlNode* set = map.find("set")) read_assignments(*set, *find_cpu(scenario.cpu), scenario.set);
    if (const auto path = optional_path(map, "input")) read_field(*map.find("input"), *path, scenario);
    if (const YamlNode* clock = map.find("clock"))
      scenario.clock =
          value(clock, "time from 1990 to 2089", "2026-11-21 10:00:00", [](const std::string& t) { return parse_clock(t); });
    if (const auto after = time(map.find("after"))) scenario.after = *after;
    if (const auto pause = span(map.find("pause"))) scenario.pause = *pause;
    if (const auto timeout = time(map.find("timeout"))) scenario.line.timeout = *timeout;
    if (const auto tolerance = time(map.find("tolerance"))) scenario.tolerance = *tolerance;
    return true;
  }

  static std::string cpu_names() {
    std::string names;
    for (const CpuModel* model : all_cpus()) names.append(names.empty() ? "" : ", ").append(model->name);
    return names;
  }

  std::optional<std::string> optional_text(const YamlNode& map, std::string_view key) {
    const YamlNode* node = map.find(key);
    auto written = node ? text(*node) : std::nullopt;
    return written && written->empty() ? std::nullopt : written;
  }
  /// A path from the folder of this file. One that was given from outside is from the folder of that file already.
  std::optional<std::string> optional_path(const YamlNode& map, std::string_view key) {
    const auto path = optional_text(map, key);
    if (!path) return {};
    const bool given =
        given_ && given_->parameters.values.contains(key) && map.find(key)->text == fmt::format("${{{}}}", key);
    return given ? *path : beside(folder_, *path);
  }

  void read_rule(const YamlNode& map, Rule& rule) {
    if (const auto id = optional_text(map, "rule")) rule.id = *id;
    if (const auto source = optional_text(map, "source")) rule.source = *source;
    if (const auto severity = choice<Rule::Severity>(map.find("severity"),
                                                     {{"must", Rule::Severity::Must}, {"should", Rule::Severity::Should}}))
      rule.severity = *severity;
  }

  void read_line(const YamlNode& map, serial::MasterSettings& line) {
    if (!map.is_map())
      return wrong(map, "'line' is a map, not " + to_text(map), "write for example line: {baud: 19200, parity: none}");
    check_keys(map, {Where::Line});
    if (const auto baud = number(map.find("baud"), 50, 1'000'000)) line.baud = static_cast<std::uint32_t>(*baud);
    if (const auto parity =
            choice<Parity>(map.find("parity"), {{"none", Parity::None}, {"even", Parity::Even}, {"odd", Parity::Odd}}))
      line.parity = *parity;
    if (const auto bits = number(map.find("data_bits"), 7, 8)) line.data_bits = static_cast<std::uint8_t>(*bits);
    if (const auto bits = number(map.find("stop_bits"), 1, 2)) line.stop_bits = static_cast<std::uint8_t>(*bits);
  }

  void read_field(const YamlNode& node, const std::string& path, Scenario& scenario) {
    std::string why;
    const auto csv = read_file(path, why);
    if (!csv) return wrong(node, fmt::format("cannot read {}: {}", path, why));
    std::vector<std::string> errors;
    scenario.input_file = path;
    scenario.field = serial::parse_field_script(*csv, path, *find_cpu(scenario.cpu), errors);
    if (!errors.empty())
      wrong(node, errors[0], errors.size() > 1 ? fmt::format("and {} more mistakes in it", errors.size() - 1) : "");
  }

  /// `map` without its key would do: an address has colons, blanks and points.
  std::optional<Assignment> assignment(const YamlNode& key, const YamlNode& item, const CpuModel& model) {
    const auto address = text(key), written = text(item);
    if (!address || !written) return {};
    std::string why;
    if (!parse_range(*address, model, why)) {
      wrong(key, why);
      return {};
    }
    auto result = parse_assignment(fmt::format("{}={}", *address, *written), model, why);
    if (!result)
      wrong(item, fmt::format("'{}' does not fit {}", stl::shortened(*written), *address),
            "write a number such as 5, -5, 16#1234, or 1.5 for a double word");
    return result;
  }

  void read_assignments(const YamlNode& map, const CpuModel& model, std::vector<Assignment>& assignments) {
    if (!map.is_map())
      return wrong(map, "addresses and values are a map, not " + to_text(map), "write for example {VW20: 16#1234, I0.3: 1}");
    for (std::size_t i = 0; i < map.keys.size() && i < map.items.size(); ++i)
      if (const auto one = assignment(map.keys[i], map.items[i], model)) assignments.push_back(*one);
  }

  // --- steps ---

  /// Those of a scenario. There is at least one, unless what they need is not there.
  void read_all_steps(const YamlNode& list, Scenario& scenario) {
    const std::size_t mistakes = complaints.list.size();
    left_out_ = false;
    read_steps(list, scenario, scenario.steps);
    if (!scenario.steps.empty() || complaints.list.size() > mistakes) return;
    if (!left_out_)
      wrong(list, "no steps: nothing would be tested", "write for example - {read: holding 0, expect: accepted}");
    else if (scenario.skipped.empty())
      scenario.skipped = "not applicable: none of its steps has what it needs";
  }

  void read_steps(const YamlNode& list, const Scenario& scenario, std::vector<Step>& steps) {
    if (!list.is_list()) return wrong(list, "'steps' is a list, not " + to_text(list), "begin each step with '- '");
    for (const YamlNode& node : list.items) {
      if (too_much(node)) return;
      read_step(node, scenario, steps);
    }
  }

  /// Steps read and turns taken are limited together, so that loops of nothing end too.
  bool too_much(const YamlNode& node) {
    if (++work_ <= kMostSteps) return false;
    loop_.clear();
    wrong(node, fmt::format("more than {} steps", kMostSteps), "fewer turns of the loops will do");
    return true;
  }

  void read_step(const YamlNode& node, const Scenario& scenario, std::vector<Step>& steps) {
    if (!node.is_map()) return wrong(node, "a step is a map, not " + to_text(node), "write for example - wait: 20ms");
    const YamlNode* action = nullptr;
    for (const YamlNode& key : node.keys)
      if (std::any_of(kKeys.begin(), kKeys.end(),
                      [&](const auto& k) { return k.where == Where::Action && k.key == key.text; })) {
        if (action)
          return wrong(key, fmt::format("'{}' and '{}' in one step", action->text, key.text),
                       "begin another step with '- '");
        action = &key;
      }
    if (!action) {
      std::string known;
      for (const ScenarioKey& k : kKeys)
        if (k.where == Where::Action) known.append(known.empty() ? "" : ", ").append(k.key);
      return wrong(node.keys.empty() ? node : node.keys[0], "a step that does nothing", "it has one of: " + known);
    }
    check_keys(node, {Where::Modifier}, action->text);
    std::string missing;
    if (!has_what_it_needs(node, missing)) {
      left_out_ = true;
      return;
    }
    const YamlNode& is = *node.find(action->text);
    if (action->text == "repeat") return read_repeat(node, is, scenario, steps);
    if (action->text == "for") return read_for(node, is, scenario, steps);
    Step step{.key = key_of(action->text), .position = action->position, .loop = loop_};
    step.position.length = static_cast<std::uint32_t>(action->text.size());
    if (const auto note = optional_text(node, "note")) step.note = *note;
    read_action(action->text, node, is, scenario, step);
    steps.push_back(std::move(step));
  }

  /// As it stands in the table.
  static std::string_view key_of(std::string_view action) {
    return std::find_if(kKeys.begin(), kKeys.end(),
                        [&](const auto& k) { return k.where == Where::Action && k.key == action; })
        ->key;
  }

  void read_action(const std::string& action, const YamlNode& node, const YamlNode& is, const Scenario& scenario,
                   Step& step) {
    const CpuModel& model = *find_cpu(scenario.cpu);
    if (has_word(kExchanges, action)) {
      step.action = read_exchange(action, node, is, scenario);
    } else if (action == "receive") {
      step.action = read_receive(node, is, scenario);
    } else if (action == "wait") {
      step.action = read_wait(is);
    } else if (action == "wait_until") {
      step.action = WaitUntilStep{read_memory(is, model).expected, time(node.find("timeout"))};
    } else if (action == "set") {
      SetStep set;
      if (is.is_map() && is.keys.empty()) wrong(is, "nothing to set", "write for example {VW20: 16#1234, I0.3: 1}");
      read_assignments(is, model, set.assignments);
      step.action = std::move(set);
    } else if (action == "memory") {
      step.action = read_memory(is, model);
    } else if (action == "interrupts") {
      step.action = read_interrupts(is);
    } else if (action == "mode") {
      step.action = ModeStep{choice<Mode>(&is, {{"run", Mode::Run}, {"stop", Mode::Stop}}).value_or(Mode::Run)};
    } else if (action == "fatal") {
      step.action = FatalStep{code(is, true).value_or(std::uint16_t{0})};
    } else if (action == "errors") {
      step.action = read_errors(is);
    } else if (action == "fault") {
      step.action = read_fault(is);
    } else if (action == "power_cycle") {
      step.action = PowerCycleStep{choice<bool>(&is, {{"memory kept", false}, {"memory lost", true}}).value_or(false),
                                   value(node.find("power_off"), "duration", "8h, 72h", [](const std::string& t) {
                                     return parse_duration(t);
                                   }).value_or(0)};
    }
  }

  WaitStep read_wait(const YamlNode& node) {
    const auto step =
        value(&node, kDuration, "20ms, 3.5 characters, 2 scans", [](const std::string& t) -> std::optional<WaitStep> {
          if (const auto span = parse_span(t)) return WaitStep{*span};
          const std::size_t unit = t.find(" scan");
          const auto count = unit == std::string::npos ? std::nullopt : parse_number(t.substr(0, unit));
          if (!count || *count < 1 || *count > 100'000 || (t.substr(unit) != " scans" && t.substr(unit) != " scan"))
            return {};
          return WaitStep{.scans = static_cast<std::uint64_t>(*count)};
        });
    return step.value_or(WaitStep{});
  }

  MemoryStep read_memory(const YamlNode& map, const CpuModel& model) {
    MemoryStep step;
    if (!map.is_map() || map.keys.empty()) {
      wrong(map, "addresses and values are a map, not " + (map.is_map() ? "an empty one" : to_text(map)),
            "write for example {VW20: 16#1234, Q0.0: 1}");
      return step;
    }
    for (std::size_t i = 0; i < map.keys.size() && i < map.items.size(); ++i)
      if (auto one = memory_expected(map.keys[i], map.items[i], model)) step.expected.push_back(std::move(*one));
    return step;
  }

  std::optional<MemoryExpected> memory_expected(const YamlNode& key, const YamlNode& item, const CpuModel& model) {
    const auto address = text(key);
    std::string why;
    const auto range = address ? parse_range(*address, model, why) : std::nullopt;
    if (address && !range) wrong(key, why);
    if (!range) return {};
    if (range->count == 1) return value_expected(key, item, model);
    const auto written = text(item);
    auto pattern = written ? parse_pattern(*written, why) : std::nullopt;
    if (written && !pattern)
      wrong(item, fmt::format("'{}' are no bytes: {}", stl::shortened(*written), why), "write for example 01 02 .. 04");
    if (pattern && pattern->size() != range->bytes()) {
      wrong(item, fmt::format("{} bytes for {}, which has {}", pattern->size(), *address, range->bytes()));
      return {};
    }
    if (!pattern) return {};
    return MemoryExpected{.range = *range, .bytes = std::move(*pattern), .address = *address, .written = *written};
  }

  /// `5`, `16#1234`, `1.5`, and from … to: `5..10`, `5..`, `..1.5`
  std::optional<MemoryExpected> value_expected(const YamlNode& key, const YamlNode& item, const CpuModel& model) {
    const auto written = text(item);
    if (written && sides(*written).range) return limits_expected(key, item, *written, model);
    const auto one = assignment(key, item, model);
    if (!one) return {};
    MemoryExpected expected{.range = one->place, .address = *text(key), .written = *written};
    if (one->place.real) {
      const double value = std::bit_cast<float>(one->value);
      expected.limits = {.from = value, .to = value};
      return expected;
    }
    std::array<std::uint8_t, 4> big_endian{};
    store32(big_endian.data(), one->value);
    expected.bytes.assign(big_endian.end() - one->place.bytes(), big_endian.end());
    return expected;
  }

  std::optional<MemoryExpected> limits_expected(const YamlNode& key, const YamlNode& item, const std::string& written,
                                                const CpuModel& model) {
    const auto refuse = [&](std::string_view why) {
      wrong(item, fmt::format("'{}': {}", stl::shortened(written), why),
            "write for example 5..10, 5.., -5..5, or 1.0..2.5 for a double word");
      return std::nullopt;
    };
    const std::string address = *text(key);
    std::string why;
    MemoryExpected expected{.range = *parse_range(address, model, why), .address = address, .written = written};
    if (expected.range.width == Width::Bit) return refuse("a bit is 0 or 1");
    constexpr double kUnlimited = std::numeric_limits<double>::infinity();
    MemoryExpected::Limits limits{.from = -kUnlimited, .to = kUnlimited};
    const auto [from, to, range] = sides(written);
    int reals = 0, numbers = 0;
    for (const auto& [side, limit] : {std::pair(from, &limits.from), std::pair(to, &limits.to)}) {
      if (side.empty()) continue;
      const auto assigned = parse_assignment(fmt::format("{}={}", address, side), model, why);
      const auto number = parse_number(side);
      if (!assigned || !(number || assigned->place.real)) return refuse(fmt::format("'{}' does not fit {}", side, address));
      *limit = assigned->place.real ? std::bit_cast<float>(assigned->value) : static_cast<double>(*number);
      ++(assigned->place.real ? reals : numbers);
    }
    if (reals + numbers == 0) return refuse("neither from nor to");
    if (reals > 0 && numbers > 0) return refuse("both limits of a real are reals");
    if (limits.from > limits.to) return refuse("no value is inside");
    expected.range.real = reals > 0;
    const double largest = expected.range.width == Width::Word ? INT16_MAX : INT32_MAX;
    limits.is_signed =
        expected.range.width != Width::Byte && limits.from <= largest && (limits.to <= largest || limits.to == kUnlimited);
    const bool both = numbers > 1 && !limits.is_signed && limits.from < 0;
    if (both) return refuse("a value with a sign is not that large, and one without is not below 0");
    expected.limits = limits;
    return expected;
  }

  Count count(const YamlNode& node) {
    return value(&node, "count", "3, 1..3, 1..", [](const std::string& t) { return parse_count(t); }).value_or(Count{});
  }

  InterruptsStep read_interrupts(const YamlNode& map) {
    InterruptsStep step;
    if (!map.is_map() || map.keys.empty()) {
      wrong(map, "counts are a map, not " + (map.is_map() ? "an empty one" : to_text(map)),
            "write for example {INT 123: 7, event 10: 1, lost: 0}");
      return step;
    }
    for (std::size_t i = 0; i < map.keys.size() && i < map.items.size(); ++i) {
      const auto name = text(map.keys[i]);
      if (!name) continue;
      InterruptCount one{.count = count(map.items[i])};
      const std::string what = lower_case(*name);
      const auto numbered = [&](std::string_view prefix, std::int64_t below) {
        const auto parsed = what.starts_with(prefix) ? parse_number(what.substr(prefix.size())) : std::nullopt;
        if (parsed && *parsed >= 0 && *parsed < below) one.number = static_cast<std::uint8_t>(*parsed);
        return parsed && *parsed >= 0 && *parsed < below;
      };
      if (what == "lost") {
        one.what = InterruptCount::What::Lost;
      } else if (numbered("int ", 128)) {
        one.what = InterruptCount::What::Routine;
      } else if (numbered("event ", kEvents)) {
        one.what = InterruptCount::What::Event;
      } else {
        wrong(map.keys[i], fmt::format("'{}' cannot be counted", stl::shortened(*name)),
              "write INT 0 to INT 127, event 0 to event 33, or lost");
        continue;
      }
      step.counts.push_back(one);
    }
    return step;
  }

  /// An error code as the reports show it, four hex digits.
  std::optional<std::uint16_t> code(const YamlNode& node, bool none_allowed) {
    return value(&node, "error code", none_allowed ? "0003, none" : "0092",
                 [&](const std::string& t) -> std::optional<std::uint16_t> {
                   if (none_allowed && lower_case(t) == "none") return std::uint16_t{0};
                   const auto parsed = t.size() == 4 ? parse_number("16#" + t) : std::nullopt;
                   return parsed && *parsed > 0 ? std::optional(static_cast<std::uint16_t>(*parsed)) : std::nullopt;
                 });
  }

  ErrorsStep read_errors(const YamlNode& node) {
    ErrorsStep step;
    if (node.is_scalar() && lower_case(node.text) == "none") return step;
    if (!node.is_map()) {
      wrong(node, "run-time errors are a map or 'none', not " + to_text(node), "write for example {0092: 3}");
      return step;
    }
    for (std::size_t i = 0; i < node.keys.size() && i < node.items.size(); ++i)
      if (const auto error = code(node.keys[i], false)) step.errors.push_back({*error, count(node.items[i])});
    return step;
  }

  FaultStep read_fault(const YamlNode& node) {
    const auto written = text(node);
    if (!written || lower_case(*written) == "none") return {};
    serial::ParsedFault parsed = serial::parse_fault(*written);
    if (parsed.ok()) return {std::move(parsed.fault)};
    YamlNode place = node;
    if (*written == node.text) {
      place.position.column += static_cast<std::uint32_t>(parsed.error->column - 1);
      place.position.length = static_cast<std::uint32_t>(parsed.error->length);
    }
    wrong(place, parsed.error->message);
    return {};
  }

  // --- loops ---

  void read_repeat(const YamlNode& node, const YamlNode& times, const Scenario& scenario, std::vector<Step>& steps) {
    const auto count = number(&times, 1, kLargestLoop);
    const YamlNode* body = loop_body(node);
    if (!count || !body) return;
    for (std::int64_t turn = 1; turn <= *count && !too_much(*body); ++turn)
      in_loop(fmt::format("turn {} of {}", turn, *count), [&] { read_steps(*body, scenario, steps); });
    --depth_;
  }

  void read_for(const YamlNode& node, const YamlNode& variables, const Scenario& scenario, std::vector<Step>& steps) {
    if (!variables.is_map() || variables.keys.empty())
      return wrong(variables,
                   "'for' has a map of names and values, not " + (variables.is_map() ? "an empty one" : to_text(variables)),
                   "write for example for: {count: [0, 126]}");
    const YamlNode* body = loop_body(node);
    if (!body) return;
    loop_over(variables, 0, *body, scenario, steps);
    --depth_;
  }

  /// The steps to repeat; the caller leaves the loop with --depth_ if there are any.
  const YamlNode* loop_body(const YamlNode& node) {
    const YamlNode* body = node.find("steps");
    if (!body) {
      wrong(node.keys[0], "a loop without 'steps'", "put 'steps:' and a list of steps beside it");
      return nullptr;
    }
    if (depth_ == kDeepestLoop) {
      wrong(node.keys[0], fmt::format("more than {} loops inside each other", kDeepestLoop));
      return nullptr;
    }
    ++depth_;
    return body;
  }

  template <class Body>
  void in_loop(const std::string& turn, Body body) {
    const std::string outer = loop_;
    loop_ += (loop_.empty() ? "" : ", ") + turn;
    body();
    loop_ = outer;
  }

  void loop_over(const YamlNode& variables, std::size_t which, const YamlNode& body, const Scenario& scenario,
                 std::vector<Step>& steps) {
    if (which == variables.keys.size() || which == variables.items.size()) return read_steps(body, scenario, steps);
    const std::string& name = variables.keys[which].text;
    const auto kept = parameters_.values;
    for (const std::string& each : loop_values(variables.items[which])) {
      if (too_much(body)) break;
      parameters_.values[name] = each;
      in_loop(fmt::format("{} = {}", name, stl::shortened(each)),
              [&] { loop_over(variables, which + 1, body, scenario, steps); });
    }
    parameters_.values = kept;
  }

  /// A list as it stands, `1..8`, or the name of a list.
  std::vector<std::string> loop_values(const YamlNode& node) {
    std::vector<std::string> values;
    if (node.is_list()) {
      for (const YamlNode& item : node.items)
        if (const auto one = text(item)) values.push_back(*one);
      return values;
    }
    const auto written = text(node);
    if (!written) return values;
    if (const auto list = parameters_.lists.find(*written); list != parameters_.lists.end()) return list->second;
    const auto range = written->find("..") == std::string::npos ? std::nullopt : parse_count(*written);
    if (!range || range->to - range->from >= kLargestLoop) {
      wrong(
          node, fmt::format("'{}' are no values for a loop", stl::shortened(*written)),
          fmt::format("write a list, a range such as 1..8 of {} values at most, or the name of a list among the parameters",
                      kLargestLoop));
      return values;
    }
    for (std::uint64_t i = range->from; i <= range->to; ++i) values.push_back(std::to_string(i));
    return values;
  }

  // --- exchanges ---

  ExchangeStep read_exchange(const std::string& action, const YamlNode& node, const YamlNode& is, const Scenario& scenario) {
    ExchangeStep step;
    step.has_crc = true;
    if (action == "send")
      read_send(node, is, step);
    else if (action == "request")
      step.request = with_station(node, pdu(is));
    else if (action == "read")
      step.request = with_station(node, read_pdu(node, is));
    else
      step.request = with_station(node, write_pdu(node, is));
    read_expectations(node, step);
    if (action == "read") check_values(node, step);
    if (is.is_map() && !step.has_crc) check_answers_to_text(node, step);
    read_reception(node, scenario, step);
    step.at = time(node.find("at"));
    step.pause = span(node.find("pause"));
    step.gap = span(node.find("gap")).value_or(Span{});
    if (step.at && step.pause) wrong(*node.find("at"), "both 'at' and 'pause'", "one of them says when the request begins");
    return step;
  }

  void read_reception(const YamlNode& node, const Scenario& scenario, Reception& reception) {
    if (const YamlNode* latency = node.find("latency")) reception.latency = window(*latency, scenario.tolerance);
    if (const YamlNode* gap = node.find("answer_gap")) reception.answer_gap = window(*gap, scenario.tolerance);
    reception.disturbed = truth(node.find("disturbed"));
    reception.listen = span(node.find("listen"));
    reception.timeout = time(node.find("timeout"));
  }

  bool truth(const YamlNode* node) { return choice<bool>(node, {{"true", true}, {"false", false}}).value_or(false); }

  ReceiveStep read_receive(const YamlNode& node, const YamlNode& is, const Scenario& scenario) {
    using Kind = Expected::Kind;
    ReceiveStep step;
    step.has_crc = truth(node.find("crc"));
    read_reception(node, scenario, step);
    if (const YamlNode* at = node.find("at")) step.at = window(*at, scenario.tolerance);
    auto expected = read_expected(is);
    if (!expected) return step;
    if (expected->kind != Kind::Any && expected->kind != Kind::Silence && expected->kind != Kind::Frame)
      wrong(is, "'receive' waits for what nobody asked for: any, silence, hex or {text: ...}",
            "an answer to a request stands in 'expect:'");
    step.expected.push_back(std::move(*expected));
    return step;
  }

  std::optional<Window> window(const YamlNode& node, Time tolerance) {
    return value(&node, "window of time", "8ms..20ms, ..20ms, 3.5 characters.., 12.5ms",
                 [&](const std::string& t) { return parse_window(t, tolerance); });
  }

  serial::Frame frame(const YamlNode& node) {
    const auto written = text(node);
    if (!written) return {};
    serial::ParsedFrame parsed = serial::parse_hex_frame(*written);
    if (parsed.ok()) return std::move(parsed.frame);
    wrong(node, parsed.errors[0].message, "write a frame in hex, such as 01 03 00 0a");
    return {};
  }

  /// What stands in `{text: …}`.
  std::optional<std::string> text_inside(const YamlNode& map) {
    if (map.keys.size() == 1 && map.keys[0].text == "text") return text(map.items[0]);
    wrong(map, "a map here is {text: ...} and nothing else", R"(write for example {text: 'HELLO\r'})");
    return {};
  }

  serial::Frame text_frame(const YamlNode& map) {
    const auto written = text_inside(map);
    if (!written) return {};
    serial::ParsedFrame parsed = parse_text(*written);
    if (!parsed.ok()) wrong(map.items[0], parsed.errors[0].message, R"(write for example {text: 'HELLO\r'})");
    return std::move(parsed.frame);
  }

  void read_send(const YamlNode& node, const YamlNode& is, ExchangeStep& step) {
    step.request = is.is_map() ? text_frame(is) : frame(is);
    step.has_crc = truth(node.find("crc"));
    if (step.has_crc) modbus::append_crc(step.request);
  }

  Bytes pdu(const YamlNode& node) {
    const serial::Frame parsed = frame(node);
    if (serial::has_wrong_parity(parsed)) wrong(node, "a byte with wrong parity in a request", "'send' has them");
    return serial::bytes_of(parsed);
  }

  serial::Frame with_station(const YamlNode& node, const Bytes& pdu) {
    const auto station = number(node.find("station"), 0, 255).value_or(station_);
    return serial::to_frame(modbus::rtu_frame(static_cast<std::uint8_t>(station), pdu));
  }

  /// `holding 10` or `40011`
  std::optional<modbus::DataAddress> place(const YamlNode& node, bool to_write) {
    const auto written = text(node);
    if (!written) return {};
    std::string why;
    auto address =
        written->find(' ') == std::string::npos ? modbus::parse_address(*written, why) : area_and_number(*written, why);
    if (address && to_write && !modbus::row_of(address->area).write_one) {
      why = fmt::format("{}s cannot be written", modbus::row_of(address->area).singular);
      address.reset();
    }
    if (!address) wrong(node, why, "write for example holding 10, coils 0, or 40011");
    return address;
  }
  static std::optional<modbus::DataAddress> area_and_number(const std::string& written, std::string& why) {
    const std::size_t blank = written.find(' ');
    const auto first = parse_number(written.substr(blank));
    for (const modbus::AreaRow& row : modbus::areas())
      if (row.word == lower_case(written.substr(0, blank)) && first && *first >= 0 && *first <= 0xFFFF)
        return modbus::DataAddress{row.area, static_cast<std::uint16_t>(*first)};
    std::string words;
    for (const modbus::AreaRow& row : modbus::areas()) words.append(words.empty() ? "" : ", ").append(row.word);
    why = fmt::format("'{}' is no place: one of {}, and a number from 0 to 65535", stl::shortened(written), words);
    return {};
  }

  Bytes read_pdu(const YamlNode& node, const YamlNode& is) {
    const auto where = place(is, false);
    const auto count = static_cast<std::uint16_t>(number(node.find("count"), 0, 0xFFFF).value_or(1));
    if (!where) return {};
    Bytes pdu = modbus::read_holding_registers(where->address, count);
    pdu[0] = static_cast<std::uint8_t>(modbus::row_of(where->area).read);
    return pdu;
  }

  Bytes write_pdu(const YamlNode& node, const YamlNode& is) {
    const auto where = place(is, true);
    const YamlNode* one = node.find("value");
    const YamlNode* several = node.find("values");
    if (!one == !several)
      wrong(one ? *one : is, one ? "both 'value' and 'values'" : "neither 'value' nor 'values'",
            "value: 1 writes one, values: [1, 0] several");
    if (!where || !one == !several) return {};
    const std::uint16_t first = where->address;
    const bool coils = modbus::row_of(where->area).bits;
    if (one) {
      const auto written = number(one, coils ? 0 : -0x8000, coils ? 1 : 0xFFFF);
      if (!written) return {};
      return coils ? modbus::write_coil(first, *written != 0)
                   : modbus::write_register(first, static_cast<std::uint16_t>(*written));
    }
    std::vector<std::uint16_t> words;
    for (const auto& word : numbers(*several, coils ? 1 : 0xFFFF, false)) words.push_back(word.value_or(std::uint16_t{0}));
    if (coils) return modbus::write_coils(first, std::vector<bool>(words.begin(), words.end()));
    return modbus::write_registers(first, words);
  }

  /// A list of numbers; `..` is any, where that makes sense.
  std::vector<std::optional<std::uint16_t>> numbers(const YamlNode& list, std::int64_t largest, bool any_allowed) {
    std::vector<std::optional<std::uint16_t>> found;
    if (!list.is_list()) {
      wrong(list, "values are a list, not " + to_text(list), "write for example [16#1234, 0]");
      return found;
    }
    constexpr std::size_t kMost = 2040;  // bits that 255 bytes hold
    if (list.items.size() > kMost) wrong(list, fmt::format("more than {} values", kMost));
    for (const YamlNode& item : list.items) {
      if (any_allowed && item.is_scalar() && item.text == "..") {
        found.push_back(std::nullopt);
      } else if (const auto one = number(&item, largest == 1 ? 0 : -0x8000, largest)) {
        found.push_back(static_cast<std::uint16_t>(*one));
      }
    }
    return found;
  }

  void read_expectations(const YamlNode& node, ExchangeStep& step) {
    const YamlNode* one = node.find("expect");
    const YamlNode* several = node.find("expect_one_of");
    if (one && several) wrong(*several, "both 'expect' and 'expect_one_of'");
    if (one) {
      if (auto expected = read_expected(*one)) step.expected.push_back(std::move(*expected));
    } else if (several && !several->is_list()) {
      wrong(*several, "'expect_one_of' is a list, not " + to_text(*several), "write for example [silence, exception 3]");
    } else if (several && several->items.empty()) {
      wrong(*several, "'expect_one_of' expects nothing", "write for example [silence, exception 3]");
    } else if (several) {
      for (const YamlNode& each : several->items)
        if (auto expected = read_expected(each)) step.expected.push_back(std::move(*expected));
    }
  }

  /// Complains about what only an answer of Modbus can be.
  void check_answers_to_text(const YamlNode& node, const ExchangeStep& step) {
    using Kind = Expected::Kind;
    for (const Expected& expected : step.expected)
      if (expected.kind == Kind::Exception || expected.kind == Kind::Values || expected.kind == Kind::Accepted ||
          expected.kind == Kind::Refused)
        wrong(*node.find(node.find("expect") ? "expect" : "expect_one_of"),
              "values, accepted, refused and exceptions are answers of Modbus, and a text is not a Modbus request",
              R"(write for example {text: 'OK\r'}, hex, any, silence or echo)");
  }

  /// Complains about values that no right answer to a read can have.
  void check_values(const YamlNode& node, const ExchangeStep& step) {
    const Bytes request = serial::bytes_of(step.request);
    if (request.size() < 6) return;
    const bool bits = request[1] <= 2;
    const auto count = static_cast<std::size_t>(request[4] << 8 | request[5]);
    for (const Expected& expected : step.expected) {
      if (expected.kind != Expected::Kind::Values) continue;
      const YamlNode& place = *node.find(node.find("expect") ? "expect" : "expect_one_of");
      if (expected.values.size() != count)
        wrong(place, fmt::format("{} read, {} expected", count, expected.values.size()),
              fmt::format("write count: {}, or as many values", expected.values.size()));
      if (bits && std::any_of(expected.values.begin(), expected.values.end(), [](auto v) { return v.value_or(0) > 1; }))
        wrong(place, "coils and inputs are 0 or 1");
    }
  }

  std::optional<Expected> read_expected(const YamlNode& node) {
    using Kind = Expected::Kind;
    if (node.is_map()) return text_expected(node);
    if (node.is_list()) return Expected{.kind = Kind::Values, .values = numbers(node, 0xFFFF, true)};
    const auto written = text(node);
    if (!written) return {};
    const std::string word = lower_case(*written);
    for (const auto& [name, kind] : {std::pair("silence", Kind::Silence),
                                     {"any", Kind::Any},
                                     {"echo", Kind::Echo},
                                     {"accepted", Kind::Accepted},
                                     {"refused", Kind::Refused}})
      if (word == name) return Expected{.kind = kind};
    if (word.starts_with("exception ")) {
      const auto parsed = parse_number(word.substr(10));
      if (parsed && *parsed > 0 && *parsed <= 0xFF)
        return Expected{.kind = Kind::Exception, .exception = static_cast<std::uint8_t>(*parsed)};
      wrong(node, fmt::format("'{}' is no exception", stl::shortened(*written)), "write for example exception 2");
      return {};
    }
    std::string why;
    auto pattern = parse_pattern(*written, why);
    if (!pattern) {
      wrong(node, fmt::format("'{}' is no answer: {}", stl::shortened(*written), why),
            "write hex such as 01 03 .. .., {text: 'OK\\r'}, any, silence, echo, accepted, refused, exception 2, or "
            "values such as [16#1234, 0]");
      return {};
    }
    return Expected{.kind = Kind::Frame, .frame = std::move(*pattern)};
  }

  std::optional<Expected> text_expected(const YamlNode& map) {
    const auto written = text_inside(map);
    if (!written) return {};
    std::string why;
    auto pattern = parse_text_pattern(*written, why);
    if (!pattern) {
      wrong(map.items[0], why, R"(write for example {text: 'T=\?\?\r'})");
      return {};
    }
    return Expected{.kind = Expected::Kind::Frame, .frame = std::move(*pattern)};
  }

  ScenarioFile& file_;
  std::string folder_;
  const GivenParameters* given_;
  Parameters parameters_;
  std::int64_t station_ = 1;
  std::string loop_;
  int depth_ = 0;
  std::size_t work_ = 0;
  bool left_out_ = false;  ///< a step of this scenario, for want of what it needs
};

void sort_out(stl::Diagnostics& into, const stl::Diagnostics& more) {
  into.insert(into.end(), more.begin(), more.end());
  stl::sort(into);
}

}  // namespace

const std::vector<ScenarioKey>& scenario_keys() { return kKeys; }

std::optional<GivenParameters> read_parameters(const std::string& text, const std::string& path,
                                               stl::Diagnostics& diagnostics) {
  GivenParameters given;
  given.source = source_of(text, path);
  const auto root = read_yaml(text, *given.source, diagnostics);
  if (!root) return {};
  Complaints complaints;
  ParameterTree(given.parameters, given.names, complaints).read(*root, "");
  for (const char* name : {"program", "times"})
    if (const auto found = given.parameters.values.find(name); found != given.parameters.values.end())
      found->second = beside(folder_of(path), found->second);
  sort_out(diagnostics, complaints.list);
  if (has_errors(diagnostics)) return {};
  return given;
}

ScenarioFile read_scenarios(const std::string& text, const std::string& path, const GivenParameters* given) {
  ScenarioFile file;
  file.source = source_of(text, path);
  const auto root = read_yaml(text, *file.source, file.diagnostics);
  if (!root) return file;
  Reader reader(file, path, given);
  reader.read(*root);
  sort_out(file.diagnostics, reader.complaints.list);
  stl::sort(file.given_diagnostics);
  return file;
}

std::string scenario_keys_markdown() {
  static constexpr std::pair<Where, std::string_view> kTables[] = {
      {Where::File, "Of a file"},
      {Where::Scenario, "Of a scenario, or of a file for all its scenarios"},
      {Where::Line, "Inside `line:`"},
      {Where::Action, "A step has one of these"},
      {Where::Modifier, "and may have these beside it"}};
  std::string text;
  for (const auto& [where, heading] : kTables) {
    const bool modifiers = where == Where::Modifier;
    text += fmt::format("{}| {} |{} |\n|---|{}---|\n", text.empty() ? "" : "\n", heading, modifiers ? " beside |" : "",
                        modifiers ? "---|" : "");
    for (const ScenarioKey& key : kKeys) {
      if (key.where != where) continue;
      std::string beside = modifiers ? fmt::format(" {} |", key.of.empty() ? "any" : key.of) : "";
      text += fmt::format("| `{}: {}` |{} {} |\n", key.key, key.form, beside, key.meaning);
    }
  }
  return text;
}

}  // namespace s7200::tools
