#include "tools/plan/system_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "interpreter/analysis/effects/looks.hpp"
#include "interpreter/base/text/joined.hpp"
#include "interpreter/base/text/text.hpp"
#include "serial_sim/line/line.hpp"
#include "tools/plan/plc_keys.hpp"

namespace s7200::tools {
namespace {

std::string no_plc_on(const LinePlan& line) { return fmt::format("no PLC is on line '{}'", line.name); }

Result<Spot> beside_first_plc(const SystemPlan& plan, std::size_t line) {
  if (const StationPlan* const first = first_plc(plan.lines[line])) return Spot{line, first->number, first->port};
  if (first_other_plc(plan, plan.lines[line]))
    return trouble("no S7-200 is on line '{}' for a master to stand beside", plan.lines[line].name);
  return Trouble{no_plc_on(plan.lines[line])};
}

/// Finds a PLC's spot: `gateway`, `gateway.1`
Result<Spot> at_plc(const SystemPlan& plan, std::string_view name) {
  const std::size_t dot = name.find('.');
  const std::string_view plc = name.substr(0, dot), port = dot == name.npos ? "0" : name.substr(dot + 1);
  bool known = false;
  for (std::size_t line = 0; line < plan.lines.size(); ++line)
    for (const StationPlan& station : plan.lines[line].stations) {
      if (station.kind != StationPlan::Kind::Plc || plan.plcs[station.number].name != plc) continue;
      known = true;
      if (port == fmt::format("{}", station.port)) return Spot{line, station.number, station.port};
    }
  return Trouble{known ? fmt::format("port {} of '{}' is on no line", stl::shortened(std::string(port)), plc)
                       : fmt::format("there is no line or PLC '{}': the lines are {}, the PLCs {}",
                                     stl::shortened(std::string(plc)), stl::joined(plan.lines, &LinePlan::name),
                                     stl::joined(plan.plcs, &PlcPlan::name))};
}

}  // namespace

std::vector<FaultPlan> of_anyone(const std::vector<serial::Fault>& faults) {
  std::vector<FaultPlan> plans;
  for (const serial::Fault& fault : faults) plans.push_back({.fault = fault});
  return plans;
}

EventSubject subject_of(const EventPlan& event) {
  using What = EventPlan::What;
  switch (event.what) {
    case What::PowerOff:
    case What::PowerOn:
      return {.station = event.station};
    case What::Set:
      return {.station = StationPlan{.kind = StationPlan::Kind::Plc, .number = event.plc}};
    case What::Cut:
    case What::Mend:
    case What::Fault:
    case What::ClearFaults:
      return {.line = event.line};
  }
  return {};
}

SystemPlan plan_of(std::shared_ptr<const Program> program, const ProgramSettings& settings, serial::FieldScript field) {
  SystemPlan plan;
  plan.plcs.push_back({.name = "", .program = std::move(program), .settings = settings, .field = std::move(field)});
  plan.lines.push_back({.name = "",
                        .faults = of_anyone(settings.faults),
                        .contention = {},  // as a scenario's own line, which needs no seed
                        .captures = settings.captures,
                        .stations = {{StationPlan::Kind::Plc, 0, static_cast<std::uint8_t>(settings.port)}}});
  return plan;
}

std::optional<SystemPlan> read_plan_of(std::shared_ptr<const Program> program, const ProgramSettings& settings,
                                       const FileSource& files, std::vector<std::string>& problems) {
  const CpuModel& model = *program->model;
  if (settings.port >= model.ports)
    problems.push_back(
        fmt::format("CPU {} has no port {}; a second port needs {}", model.name, settings.port, s7200::to_text(kTwoPorts)));
  auto field = read_field(settings.input, *program, files, problems);
  if (!field || !problems.empty()) return {};
  return plan_of(std::move(program), settings, std::move(*field));
}

SystemPlan plan_of_other_plc(std::shared_ptr<const serial::Automaton> automaton, const std::vector<serial::Fault>& faults,
                             std::vector<std::string> captures) {
  SystemPlan plan;
  plan.peers.push_back({.name = "", .automaton = std::move(automaton)});
  plan.lines.push_back({.name = "",
                        .faults = of_anyone(faults),
                        .contention = {},
                        .captures = std::move(captures),
                        .stations = {{.kind = StationPlan::Kind::Peer}}});
  return plan;
}

bool is_of_one_program(const SystemPlan& plan) { return plan.plcs.size() == 1 && plan.lines.front().name.empty(); }

const std::string& name_of(const SystemPlan& plan, const StationPlan& station) {
  if (station.kind == StationPlan::Kind::Plc) return plan.plcs[station.number].name;
  return station.kind == StationPlan::Kind::Peer ? plan.peers[station.number].name : plan.bridges[station.number].name;
}

serial::MasterSettings on_line(serial::MasterSettings master, const LinePlan& line) {
  serial::LineSettings settings = line.settings;
  settings.override_with(master);
  master.override_with(settings);
  return master;
}

const StationPlan* first_plc(const LinePlan& line) {
  const auto found = std::ranges::find(line.stations, StationPlan::Kind::Plc, &StationPlan::kind);
  return found == line.stations.end() ? nullptr : &*found;
}

const StationPlan* first_other_plc(const SystemPlan& plan, const LinePlan& line) {
  const auto found = std::ranges::find_if(line.stations, [&](const StationPlan& station) {
    return station.kind == StationPlan::Kind::Peer && plan.peers[station.number].automaton;
  });
  return found == line.stations.end() ? nullptr : &*found;
}

SerialFormat format_without_s7200(const SystemPlan& plan, const LinePlan& line) {
  const StationPlan* const other = first_other_plc(plan, line);
  return other ? plan.peers[other->number].automaton->format() : SerialFormat{};
}

Result<Spot> find_spot(const SystemPlan& plan, std::string_view name) {
  const auto line = find_line(plan, name);
  if (line) return beside_first_plc(plan, *line);
  return name.empty() ? line.trouble() : at_plc(plan, name);
}

Result<std::size_t> find_line(const SystemPlan& plan, std::string_view name) {
  if (name.empty() && plan.lines.size() > 1)
    return trouble("there are several lines, {}: name one of them{}", stl::joined(plan.lines, &LinePlan::name),
                   plan.plcs.empty() ? "" : ", or a PLC");
  const auto line = name.empty() ? plan.lines.begin() : std::ranges::find(plan.lines, name, &LinePlan::name);
  if (line != plan.lines.end()) return static_cast<std::size_t>(line - plan.lines.begin());
  return trouble("there is no line '{}': the lines are {}", stl::shortened(std::string(name)),
                 stl::joined(plan.lines, &LinePlan::name));
}

std::vector<Spot> spots_of_plcs(const SystemPlan& plan) {
  std::vector<std::optional<Spot>> found(plan.plcs.size());
  for (std::size_t line = 0; line < plan.lines.size(); ++line)
    for (const StationPlan& station : plan.lines[line].stations)
      if (station.kind == StationPlan::Kind::Plc && !found[station.number])
        found[station.number] = Spot{line, station.number, station.port};
  std::vector<Spot> spots;
  for (const auto& spot : found) spots.push_back(spot.value());
  return spots;
}

std::string why_no_room(const SystemPlan& plan, std::size_t line) {
  const std::vector<StationPlan>& stations = plan.lines[line].stations;
  if (stations.size() < serial::Line::kDrivers) return {};
  return fmt::format("line '{}' has {} stations already, as many as a line takes: there is no place for one more master",
                     plan.lines[line].name, stations.size());
}

std::string why_no_other_plc(const SystemPlan& plan, std::size_t line) {
  return first_other_plc(plan, plan.lines[line]) ? why_no_room(plan, line) : no_plc_on(plan.lines[line]);
}

std::optional<std::size_t> first_askable_line(const SystemPlan& plan) {
  for (std::size_t line = 0; line < plan.lines.size(); ++line)
    if (why_no_other_plc(plan, line).empty()) return line;
  return {};
}

void run_every_scan(SystemPlan& plan) {
  for (PlcPlan& plc : plan.plcs) plc.program = with_every_scan(*plc.program);
}

void forget_files(SystemPlan& plan) {
  for (const PlcKey& key : plc_keys())
    if (key.shape == PlcKey::Shape::Written)
      for (PlcPlan& plc : plan.plcs) key.take(plc.settings, "", nullptr);
  for (LinePlan& line : plan.lines) line.captures.clear();
}

}  // namespace s7200::tools
