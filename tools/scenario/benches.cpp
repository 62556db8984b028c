#include "tools/scenario/benches.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "interpreter/analysis/effects/looks.hpp"
#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/program/loading/load_times.hpp"
#include "interpreter/program/loading/slips.hpp"
#include "interpreter/program/loading/stand_ins.hpp"
#include "tools/host/files/files.hpp"
#include "tools/plan/other_plc.hpp"
#include "tools/plan/reading/system_reader.hpp"
#include "tools/slave/slave_in_rig.hpp"
#include "tools/slave/slave_target.hpp"

namespace s7200::tools {

std::string Programs::Loaded::why() const {
  constexpr std::size_t kMost = 3;
  std::string text;
  const auto add = [&](const std::string& line) { text.append(text.empty() ? "" : "\n").append(line); };
  for (const Message& message : messages) {
    if (message.kind != Message::Kind::Diagnostics) {
      add(message.text);
      continue;
    }
    const stl::Diagnostics& all = message.diagnostics;
    const std::string& name = message.source->name;
    for (std::size_t i = 0; i < std::min(kMost, all.size()); ++i) {
      const stl::FileLine place = stl::in_file(*message.source, all[i].position.line);
      add(fmt::format("{}:{}:{}: {}", place.file, place.line, all[i].position.column, all[i].message));
    }
    if (all.size() > kMost) add(fmt::format("and {} more; 's7200 check {}' shows them", all.size() - kMost, name));
  }
  return text;
}

const Programs::Loaded& Programs::get(const std::string& path, const std::vector<std::string>& with, const std::string& cpu,
                                      const std::string& times_table, const std::string& repairs) {
  std::vector<std::string> files{path};
  files.insert(files.end(), with.begin(), with.end());
  const auto key = std::tuple(files, cpu, times_table, repairs);
  const auto known = known_.find(key);
  return known != known_.end() ? known->second : known_.emplace(key, load(files, cpu, times_table, repairs)).first->second;
}

/// What comes through a pipe can be read once, by whatever name.
const Programs::Text& Programs::text_of(const std::string& path) {
  const bool from_input = is_standard_input(path);
  const std::string name = from_input ? "standard input" : path;
  const auto [found, added] = texts_.try_emplace(name);
  if (!added) return found->second;
  auto text = (from_input ? read_standard_input() : read_file(path)).and_then([&](const std::string& bytes) {
    return read_source(bytes, name);
  });
  if (!text) found->second.why = fmt::format("cannot read {}: {}", name, text.why());
  found->second.text = std::move(text).if_any();
  return found->second;
}

std::optional<stl::ParseResult> Programs::read(const std::vector<std::string>& files, const std::string& repairs,
                                               Messages& messages) {
  std::vector<SourceText> texts;
  for (const std::string& file : files) {
    const Text& source = text_of(file);
    if (source.text)
      texts.push_back(*source.text);
    else
      add_error(messages, source.why);
  }
  if (!messages.empty()) return {};
  SourceText project = join_files(std::move(texts));
  if (!repairs.empty()) {
    std::vector<std::string> unknown;
    repair(project.parsed.source, parse_repairs(repairs).value_or(Repairs{}), unknown);
    for (const std::string& id : unknown)
      add_error(messages, fmt::format("repair {}: {} has no such slip", id, project.parsed.source.name));
  }
  return messages.empty() ? std::optional(std::move(project.parsed)) : std::nullopt;
}

Programs::Loaded Programs::load(const std::vector<std::string>& files, const std::string& cpu,
                                const std::string& times_table, const std::string& repairs) {
  Loaded loaded;
  const CpuModel& model = *find_cpu(cpu);
  auto parsed = read(files, repairs, loaded.messages);
  if (!parsed) return loaded;
  std::vector<std::string> errors;
  auto times = load_times(model, times_table, host_files(), errors);
  for (const std::string& error : errors) add_error(loaded.messages, error);
  if (!times) return loaded;
  for (const std::string& note : parsed->notes) loaded.messages.push_back({.kind = Message::Kind::Note, .text = note});
  CheckResult result = check(std::move(*parsed), model, *times);
  loaded.times = std::move(*times);
  loaded.program = std::move(result.program);
  if (loaded.program) return loaded;
  std::erase_if(result.diagnostics, [](const auto& d) { return d.severity == stl::Severity::Warning; });
  const std::string name = result.source.name;
  loaded.messages = {{.kind = Message::Kind::Diagnostics,
                      .diagnostics = std::move(result.diagnostics),
                      .source = std::make_shared<stl::SourceLines>(std::move(result.source))},
                     {.text = fmt::format("{} has errors; nothing was run", name)}};
  return loaded;
}

std::shared_ptr<const ProgramBand> Programs::band(const std::string& path, const std::vector<std::string>& with,
                                                  const std::string& cpu, const std::string& times_table,
                                                  const std::string& repairs, const SystemBlock& block,
                                                  const BandSettings& settings) {
  std::vector<std::string> files{path};
  files.insert(files.end(), with.begin(), with.end());
  auto& known = bands_[{{files, cpu, times_table, repairs}, block}];
  if (known) return known;
  Messages messages;
  auto parsed = read(files, repairs, messages);
  const CpuModel& model = *find_cpu(cpu);
  auto tables = band_around(model, times_table, get(path, with, cpu, times_table, repairs).times, settings);
  return known = std::make_shared<ProgramBand>(std::move(*parsed), model, std::move(tables), block);
}

namespace {

/// Whose program is to be had from what the scenario names.
bool is_to_run(const Scenario& scenario) { return scenario.skipped.empty(); }

bool all_without_program(const std::vector<Scenario>& scenarios, Messages& messages) {
  const auto first = std::find_if(scenarios.begin(), scenarios.end(), is_to_run);
  if (first == scenarios.end()) return false;
  if (std::any_of(scenarios.begin(), scenarios.end(),
                  [](const Scenario& s) { return is_to_run(s) && (!s.program.empty() || s.plan); }))
    return false;
  add_error(messages, fmt::format("{}: '{}' names no program; give it 'program:', or name one with --target",
                                  first->source->name, first->name));
  return true;
}

/// On programs: that of the target for all, or each one's own.
class ProgramBenches {
 public:
  ProgramBenches(const std::string& target, const SuiteSettings& settings, Programs& programs)
      : target_(target),
        same_for_all_(!target.empty() || !settings.conformance.empty()),
        settings_(settings),
        programs_(programs) {}

  /// False, with messages, if there is none and there will be none for all others either.
  bool add_to(Bench& bench, const Scenario& scenario, std::string& name, Messages& messages) {
    if (scenario.plan) return add_system_to(bench, scenario, name, messages), true;
    const std::string& path = target_.empty() ? scenario.program : target_;
    if (path.empty()) {
      bench.problem = "it names no program, and there is no --target";
      return true;
    }
    const auto with = target_.empty() ? scenario.with : std::vector<std::string>{};
    const Programs::Loaded& loaded = programs_.get(path, with, scenario.cpu, scenario.times, scenario.repair);
    bench.program = loaded.program;
    if (loaded.program) look_for_stand_ins(*loaded.program, bench, messages);
    if (loaded.program && scenario.plc.system_block != SystemBlock{})
      bench.program = with_system_block(*loaded.program, scenario.plc.system_block);
    if (loaded.program && settings_.every_scan) bench.program = with_every_scan(*bench.program);
    if (loaded.program && (scenario.robust || settings_.band.random > 0))
      bench.band = programs_.band(path, with, scenario.cpu, scenario.times, scenario.repair, scenario.plc.system_block,
                                  band_settings());
    if (!loaded.program && same_for_all_) {
      messages.insert(messages.end(), loaded.messages.begin(), loaded.messages.end());
      return false;
    }
    if (!loaded.program) bench.problem = loaded.why();
    if (loaded.program && told_.insert(&loaded).second)
      messages.insert(messages.end(), loaded.messages.begin(), loaded.messages.end());
    if (name.empty()) name = path;
    return true;
  }

 private:
  void look_for_stand_ins(const Program& program, Bench& bench, Messages& messages) {
    for (const StandIn& stand_in : stand_ins_of(program.source)) {
      if (settings_.no_stand_ins) bench.problem = fmt::format("{}; {}", refusal(stand_in).message, refusal(stand_in).hint);
      Message note{.kind = Message::Kind::Note, .text = fmt::format("{}: {}", program.source.name, to_text(stand_in))};
      if (!settings_.no_stand_ins && noted_.insert(note.text).second) messages.push_back(std::move(note));
    }
  }

  void add_system_to(Bench& bench, const Scenario& scenario, std::string& name, Messages& messages) {
    for (const PlcPlan& plc : scenario.plan->plcs) look_for_stand_ins(*plc.program, bench, messages);
    if (!target_.empty())
      bench.problem = fmt::format("it is about the system {}, which --target cannot replace", scenario.system);
    if (settings_.band.random > 0) bench.problem = "--times-band is about one program, and this scenario about a system";
    if (name.empty()) name = scenario.system;
  }

  /// What a scenario gets that asks for a band if none is asked for on the command line.
  static constexpr std::size_t kUsualTables = 200;
  BandSettings band_settings() const {
    return {settings_.band.random > 0 ? settings_.band.random : kUsualTables, settings_.band.seed};
  }

  const std::string& target_;
  bool same_for_all_;
  const SuiteSettings& settings_;
  Programs& programs_;
  std::set<const Programs::Loaded*> told_{};
  std::set<std::string> noted_{};  // stand-ins
};

using SlaveMaker = decltype(Bench::make_slave);

/// Of a PLC of another make, with what it is told by --plc. Each scenario has one of its own.
SlaveMaker peer_slaves(const std::string& model, const std::string& name, const SuiteSettings& suite) {
  const auto make = [model, settings = suite.plc, protocol = suite.protocol] {
    auto plc = make_other_plc(protocol, model, settings);
    if (!plc) throw std::invalid_argument(plc.why());
    return *std::move(plc);
  };
  make();  // or it throws
  return [make, name, stop = suite.stop](const Scenario& scenario) {
    auto slave = join_lines(plan_of_other_plc(make()), 0, scenario.line, kNever, name, stop);
    if (scenario.after != kNever) slave->wait(std::max<Time>(0, scenario.after - slave->now()));
    return slave;
  };
}

/// Of a system without an S7-200, on the line `at`. Null, with messages, if there is no such line.
SlaveMaker peer_lines(SystemPlan plan, const std::string& path, const std::string& at, StopToken stop, Messages& messages) {
  const auto line = find_line(plan, at);
  const std::string why = line ? why_no_other_plc(plan, *line) : line.why();
  if (!why.empty()) return add_error(messages, fmt::format("{}: {}{}", path, why, line ? "" : " (--at NAME)")), nullptr;
  forget_files(plan);
  return [plan = std::make_shared<const SystemPlan>(std::move(plan)), line = *line, path, stop](const Scenario& scenario) {
    return join_lines(*plan, line, scenario.line, scenario.after, path, stop);
  };
}

/// Of a system file. Null, with messages, if it cannot be had.
SlaveMaker system_slaves(const std::string& path, const SuiteSettings& settings, Messages& messages) {
  const auto refuse = [&](const std::string& why) { return add_error(messages, why), nullptr; };
  const auto text = read_text(path);
  if (!text) return refuse(fmt::format("cannot read {}: {}", path, text.why()));
  SystemFile file = read_system(*text, path, host_files());
  if (!file.ok()) {
    const auto add = [&](const SystemFile::Text& one) {
      messages.push_back({.kind = Message::Kind::Diagnostics, .diagnostics = one.diagnostics, .source = one.source});
    };
    for (const SystemFile::Text& program : file.programs) add(program);
    add(file.file);
    return refuse(fmt::format("{} has errors; nothing was run", path));
  }
  if (!file.plan.bridges.empty())
    return refuse(fmt::format("bridge '{}' of {} follows the clock, which 's7200 test' does not: leave it out",
                              file.plan.bridges.front().name, path));
  if (file.plan.plcs.empty()) return peer_lines(std::move(file.plan), path, settings.at, settings.stop, messages);
  const auto spot = find_spot(file.plan, settings.at);
  if (!spot) return refuse(fmt::format("{}: {} (--at NAME)", path, spot.why()));
  if (const std::string why = why_no_room(file.plan, spot->line); !why.empty())
    return refuse(fmt::format("{}: {}", path, why));
  forget_files(file.plan);
  if (settings.every_scan) run_every_scan(file.plan);
  return [plan = std::make_shared<const SystemPlan>(std::move(file.plan)), spot = *spot, path, stop = settings.stop](
             const Scenario& scenario) { return join_spot(*plan, spot, scenario.line, scenario.after, path, stop); };
}

}  // namespace

std::optional<Benches> make_benches(const std::vector<Scenario>& scenarios, const std::string& target,
                                    const SuiteSettings& settings, Programs& programs, Messages& messages) {
  Benches benches{.name = target};
  const bool is_conformance = !settings.conformance.empty();
  const SlaveTarget parsed = target.empty() ? SlaveTarget{} : parse_slave_target(target);
  if (parsed.kind == SlaveTarget::Kind::ModbusTcp && is_conformance) {
    add_error(messages,
              "--conformance judges what a slave does on its serial line, which Modbus TCP hides; name a program, pty, "
              "device or tcp://");
    return {};
  }
  if (parsed.kind != SlaveTarget::Kind::Program && settings.band.random > 0) {
    add_error(messages, "--times-band is about execution times in simulation; the target must be a program");
    return {};
  }
  if (target.empty() && all_without_program(scenarios, messages)) return {};
  Bench of_target{.format = settings.line.over(SerialFormat{}),
                  .exchanges_wanted = settings.exchanges_wanted,
                  .observed = settings.observed,
                  .recordings_wanted = settings.runs_wanted,
                  .stop = settings.stop};
  switch (parsed.kind) {
    case SlaveTarget::Kind::Program:
      break;
    case SlaveTarget::Kind::System:
      of_target.make_slave = system_slaves(parsed.path, settings, messages);
      if (!of_target.make_slave) return {};
      break;
    case SlaveTarget::Kind::Peer:
      of_target.make_slave = peer_slaves(parsed.path, target, settings);
      break;
    case SlaveTarget::Kind::Device:
    case SlaveTarget::Kind::Tcp:
    case SlaveTarget::Kind::ModbusTcp:
      benches.slave = connect(parsed, of_target.format, modbus::crc_ok, settings.stop);
      benches.name = benches.slave->name();
      of_target.slave = benches.slave.get();
  }
  benches.of_programs = parsed.kind == SlaveTarget::Kind::Program;
  ProgramBenches of_programs(parsed.path, settings, programs);
  for (const Scenario& scenario : scenarios) {
    Bench bench = of_target;
    if (benches.of_programs && is_to_run(scenario) && !of_programs.add_to(bench, scenario, benches.name, messages))
      return {};
    benches.of.push_back(std::move(bench));
  }
  return benches;
}

}  // namespace s7200::tools
