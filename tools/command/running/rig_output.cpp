#include "tools/command/running/rig_output.hpp"

#include <fmt/format.h>

#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/stl/tables/symbols.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/views/report.hpp"
#include "tools/views/results_json.hpp"
#include "tools/views/state/faults.hpp"
#include "tools/views/state/memory.hpp"

namespace s7200::tools {
namespace {

nlohmann::ordered_json dumps_json(const PlcSettings& settings, const Cpu& cpu) {
  auto json = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < settings.dumps.size(); ++i) json[settings.dump_names[i]] = dump_json(cpu, settings.dumps[i]);
  return json;
}

nlohmann::ordered_json plc_json(const PlcPlan& plan, const serial::Plc& plc) {
  const Cpu& cpu = plc.cpu();
  const State& state = cpu.state();
  nlohmann::ordered_json json{{"name", plan.name}, {"cpu", plan.program->model->name}, {"mode", mode_of(plc)}};
  json.update(scans_json(state));
  json["instructions"] = state.instructions;
  json["errors"] = errors_json(cpu);
  json["errors_not_listed"] = errors_not_listed(cpu);
  json["dump"] = dumps_json(plan.settings, cpu);
  return json;
}

nlohmann::ordered_json poll_json(const std::string& name, const serial::Poller::State& polls) {
  nlohmann::ordered_json json{{"name", name},
                              {"requests", polls.asked},
                              {"answered", polls.answered},
                              {"refused", polls.refused},
                              {"wrong", polls.wrong}};
  json["shortest_latency_ns"] = polls.answered > polls.wrong ? nlohmann::ordered_json(polls.least_latency) : nullptr;
  json["longest_latency_ns"] = polls.answered > polls.wrong ? nlohmann::ordered_json(polls.most_latency) : nullptr;
  return json;
}

/// The symbol that a range is written with: `Level` of `Level`, `"Level"` and `Level:4`; empty for an address alone.
std::string_view symbol_in(std::string_view range, const std::vector<stl::Symbol>& symbols) {
  const std::string_view name = range.substr(0, range.find(':', range.starts_with('"') ? range.find('"', 1) : 0));
  return stl::find_symbol(symbols, name) ? name : std::string_view();
}

std::string set_to(const SerialFormat& format) { return fmt::format("{} baud {}", format.baud, character_text(format)); }

/// What `of` says of each PLC, under its name if it has one.
template <class Of>
std::string by_plc(const Rig& rig, Of of) {
  std::string text;
  for (std::size_t i = 0; i < rig.plan().plcs.size(); ++i) {
    const std::string& name = rig.plan().plcs[i].name;
    const std::string lines = of(i);
    if (!lines.empty()) text += name.empty() ? lines : fmt::format("{}:\n{}", stl::printable(name), indented(lines));
  }
  return text;
}

}  // namespace

std::string_view mode_of(const serial::Plc& plc) {
  return !plc.powered() ? "off" : plc.cpu().state().mode == Mode::Run ? "RUN" : "STOP";
}

nlohmann::ordered_json scans_json(const State& state) {
  using Json = nlohmann::ordered_json;
  return {{"scans", state.scans},
          {"shortest_scan_ns", state.scans ? Json(state.shortest_scan) : nullptr},
          {"longest_scan_ns", state.scans ? Json(state.longest_scan) : nullptr}};
}

std::string indented(const std::string& lines) {
  std::string text;
  for (const std::string& line : stl::split_lines(lines)) text += line.empty() ? "" : fmt::format("  {}\n", line);
  return text;
}

std::string dumps_text(const PlcSettings& settings, const Cpu& cpu) {
  std::string text;
  for (std::size_t i = 0; i < settings.dumps.size(); ++i) {
    const std::string& name = settings.dump_names[i];
    const std::string dump = dump_text(cpu, settings.dumps[i]);
    const std::size_t first_line = dump.find('\n');
    const std::string_view symbol = symbol_in(name, cpu.program().source.symbols);
    text += dump.substr(0, first_line) + (symbol.empty() ? "" : fmt::format("  {}", stl::printable(symbol))) +
            dump.substr(first_line);
  }
  return text;
}

std::string dump_text(const Rig& rig) {
  return by_plc(rig, [&](std::size_t plc) { return dumps_text(rig.plan().plcs[plc].settings, rig.plc(plc).cpu()); });
}

std::string errors_text(const Rig& rig) {
  return by_plc(rig, [&](std::size_t plc) { return errors_text(rig.plc(plc).cpu()); });
}

StationName stations_of(const Rig& rig, std::size_t line) {
  return [&rig, line](int driver) { return rig.station_at(line, driver); };
}

std::vector<std::string> fault_notes(const Rig& rig) {
  std::vector<std::string> notes;
  for (std::size_t i = 0; i < rig.plan().lines.size(); ++i) {
    const std::string& name = rig.plan().lines[i].name;
    for (const std::string& note : fault_notes(rig.faults(i), stations_of(rig, i)))
      notes.push_back(name.empty() ? note : fmt::format("{}: {}", name, note));
  }
  return notes;
}

std::vector<std::string> stop_notes(const Rig& rig) {
  std::vector<std::string> notes;
  for (std::size_t i = 0; i < rig.plan().plcs.size(); ++i) {
    const std::string& name = rig.plan().plcs[i].name;
    if (mode_of(rig.plc(i)) == "STOP") notes.push_back((name.empty() ? "" : name + ": ") + "the CPU is in STOP");
  }
  return notes;
}

std::vector<std::string> framing_notes(const Rig& rig, const CollisionsOn& collisions) {
  std::vector<std::string> notes;
  for (std::size_t i = 0; i < rig.plan().plcs.size(); ++i) {
    const serial::Plc& plc = rig.plc(i);
    const std::string& name = rig.plan().plcs[i].name;
    for (std::uint8_t port = 0; port < plc.cpu().program().model->ports; ++port) {
      if (plc.framing_errors(port) == 0 || !plc.line(port).faults().state().injected.empty()) continue;
      const std::uint64_t collided = collisions(&plc.line(port));
      const std::string why =
          collided > 0 ? fmt::format("a master spoke while the PLC was sending, {}", counted(collided, "time"))
                       : fmt::format("whoever sent them is not set to {} like the port{}", set_to(plc.port_format(port)),
                                     !is_of_one_program(rig.plan()) ? ", or two stations sent at once" : "");
      notes.push_back(fmt::format("{}port {} received {} with framing errors: {}", name.empty() ? "" : name + ": ", port,
                                  counted(plc.framing_errors(port), "character"), why));
    }
  }
  return notes;
}

std::vector<std::string> line_notes(const Rig& rig, const CollisionsOn& collisions) {
  std::vector<std::string> notes = fault_notes(rig), of_framing = framing_notes(rig, collisions);
  notes.insert(notes.end(), of_framing.begin(), of_framing.end());
  for (const LinePlan& line : rig.plan().lines) {
    const StationPlan* first = nullptr;
    for (const StationPlan& station : line.stations) {
      const auto format = rig.format_of(station);
      if (!format) continue;
      if (!first) first = &station;
      if (const SerialFormat of_first = *rig.format_of(*first); *format != of_first)
        notes.push_back(fmt::format("{}: {} is set to {}, {} to {}: they do not understand each other", line.name,
                                    name_of(rig.plan(), station), set_to(*format), name_of(rig.plan(), *first),
                                    set_to(of_first)));
    }
  }
  return notes;
}

std::string poll_text(const serial::Poller::State& polls) {
  std::string text = fmt::format("{}, {} answered", counted(polls.asked, "request"), polls.answered);
  if (polls.refused != 0) text += fmt::format(", {} of them refused", polls.refused);
  if (polls.wrong != 0) text += fmt::format(", {} {}wrong", polls.wrong, polls.refused == 0 ? "of them " : "");
  if (polls.answered > polls.wrong)
    text += fmt::format(", after {} to {}", format_duration(polls.least_latency), format_duration(polls.most_latency));
  return text;
}

nlohmann::ordered_json rig_json(const Rig& rig) {
  const SystemPlan& plan = rig.plan();
  if (is_of_one_program(rig.plan())) {
    const Cpu& cpu = rig.plc(0).cpu();
    return {{"mode", mode_of(rig.plc(0))},
            {"errors", errors_json(cpu)},
            {"errors_not_listed", errors_not_listed(cpu)},
            {"faults", faults_json(rig.faults(0))},
            {"dump", dumps_json(plan.plcs[0].settings, cpu)}};
  }
  nlohmann::ordered_json json;
  for (const char* const list : {"plcs", "masters", "lines"}) json[list] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < plan.plcs.size(); ++i) json["plcs"].push_back(plc_json(plan.plcs[i], rig.plc(i)));
  for (std::size_t i = 0; i < plan.peers.size(); ++i)
    if (const serial::Poller* poller = rig.poller(i))
      json["masters"].push_back(poll_json(plan.peers[i].name, poller->state()));
  for (std::size_t i = 0; i < plan.lines.size(); ++i)
    json["lines"].push_back({{"name", plan.lines[i].name}, {"faults", faults_json(rig.faults(i), stations_of(rig, i))}});
  return json;
}

int exit_code_of(const Rig& rig) {
  for (std::size_t i = 0; i < rig.plan().plcs.size(); ++i)
    if (const int code = exit_code_of(rig.plc(i).cpu()); code != kFine) return code;
  return kFine;
}

Timelines::Timelines(Rig& rig) : rig_(rig) {
  for (std::size_t i = 0; i < rig.plan().plcs.size(); ++i) {
    TraceSink* const records = rig.sinks(i).empty() ? nullptr : &rig.sinks(i);
    timelines_.push_back(std::make_unique<Timeline>(rig.plan().plcs[i].program, records, Timeline::Looks::AtInstructions));
  }
  rig.tell_of_events([this](std::size_t plc, Time at, const std::string& what) { timelines_[plc]->note(at, what); });
}

void Timelines::begin() {
  for (std::size_t i = 0; i < timelines_.size(); ++i) {
    timelines_[i]->begin();
    rig_.plc(i).cpu().set_sink(timelines_[i].get());
  }
}

void Timelines::end() {
  for (std::size_t i = 0; i < timelines_.size(); ++i)
    rig_.plc(i).cpu().set_sink(rig_.sinks(i).empty() ? nullptr : &rig_.sinks(i));
}

std::vector<StationTimeline> Timelines::reports() const {
  std::vector<StationTimeline> reports;
  for (std::size_t i = 0; i < timelines_.size(); ++i) reports.push_back({rig_.plan().plcs[i].name, timelines_[i]->report()});
  return reports;
}

std::string Timelines::text(const serial::Exchange& exchange, bool colour) const {
  return to_text(reports(), exchange, colour);
}

nlohmann::ordered_json Timelines::json(const serial::Exchange& exchange) const { return to_json(reports(), exchange); }

}  // namespace s7200::tools
