// The stations of a system: which one the commands are about, and what is said of each.
#include <fmt/format.h>

#include <algorithm>
#include <ostream>

#include "interpreter/base/text.hpp"
#include "tools/debugger/debugger.hpp"
#include "tools/session/stops/words.hpp"
#include "tools/views/machine_text.hpp"

namespace s7200::tools {

std::string Debugger::name_of(std::size_t station) const {
  return is_system() ? stl::printable(options_.stations[station].name) : "the PLC";
}

std::string Debugger::said_of(std::size_t station) const { return is_system() ? name_of(station) + ": " : ""; }

/// `412.345678 ms  scan 7  INT 123 …`, without the line that it stands in front of.
std::string Debugger::place_line(std::size_t station) const {
  const serial::Simulation& of = *stations_[station].simulation;
  if (!of.plc().powered()) return fmt::format("{}  without power", moment_text(history_.now().time));
  const std::string place = place_text(of.cpu(), stations_[station].listing);
  return place.substr(0, place.find('\n'));
}

/// What is wrong with a command that needs the CPU; nothing as long as it has power.
Debugger::Error Debugger::without_power(std::string_view command) const {
  if (simulation().plc().powered()) return {};
  return fmt::format("{}: {}", command, without_power_text(name_of(focus())));
}

void Debugger::say_without_power() {
  if (!simulation().plc().powered()) out_ << fmt::format("{} is without power; it was:\n", name_of(focus()));
}

std::uint64_t Debugger::errors_of_all() const {
  std::uint64_t errors = 0;
  for (const Station& station : stations_) errors += station.simulation->cpu().state().error_count;
  return errors;
}

void Debugger::look_at(std::size_t station) {
  if (station == focus()) return;
  stepper_.look_at(station);
  out_ << fmt::format("now at {}\n", name_of(station));
}

/// A peer or a bridge; null if there is none of that name.
const LineStation* Debugger::without_program(std::string_view name) const {
  for (const LineStation& one : history_.line_stations())
    if (one.kind != LineStation::Kind::Plc && one.name == name) return &one;
  return nullptr;
}

Debugger::Error Debugger::station(const Arguments& arguments) {
  if (!is_system()) return "there is one PLC only, without a name; a system file has several: s7200 debug SYSTEM.yaml";
  if (arguments.empty()) {
    for (std::size_t station = 0; station < stations_.size(); ++station)
      out_ << fmt::format("{} {:<{}}  {}\n", station == focus() ? '>' : ' ', name_of(station), name_width_,
                          place_line(station));
    for (const LineStation& one : history_.line_stations())
      if (one.kind != LineStation::Kind::Plc)
        out_ << fmt::format("  {:<{}}  {} on line {}\n", stl::printable(one.name), name_width_, kind_text(one.kind),
                            stl::printable(one.line_name));
    return {};
  }
  if (const LineStation* const other = without_program(joined(arguments)))
    return fmt::format("{} is {}; it has no program to step through", stl::printable(other->name), kind_text(other->kind));
  const auto named = std::ranges::find(options_.stations, joined(arguments), &DebuggedStation::name);
  if (named == options_.stations.end())
    return fmt::format("there is no station '{}'; 'station' lists them", stl::shortened(joined(arguments)));
  stepper_.look_at(static_cast<std::size_t>(named - options_.stations.begin()));
  show_place();
  return {};
}

}  // namespace s7200::tools
