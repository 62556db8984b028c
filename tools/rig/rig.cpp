#include "tools/rig/rig.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "serial_sim/modbus/answer.hpp"
#include "tools/rig/event_words.hpp"
#include "tools/views/state/memory.hpp"

namespace s7200::tools {
namespace {

serial::Verdict verdict_on(const serial::Exchange& exchange) {
  if (!exchange.damage().empty()) return serial::Verdict::Wrong;
  return modbus::check_answer(serial::bytes_of(exchange.request), exchange.response_bytes()).verdict;
}

/// A master that has joined the line raises the sync signal of the PLCs there that no output drives.
void drive_sync(serial::RequesterStation& master, const SystemPlan& plan, const LinePlan& line,
                const std::vector<serial::ResponderStation*>& responders) {
  std::vector<serial::ResponderStation*> driven;
  for (const StationPlan& station : line.stations)
    if (station.kind == StationPlan::Kind::Peer && responders[station.number] && !plan.peers[station.number].sync)
      driven.push_back(responders[station.number]);
  if (driven.empty()) return;
  master.requester().when_sync([driven](bool high, Time at) {
    for (serial::ResponderStation* const each : driven) each->responder().sync(high, at);
  });
}

}  // namespace

Rig::Rig(SystemPlan plan, const RigSpots& seen)
    : plan_(std::move(plan)),
      sinks_(plan_.plcs.size()),
      pollers_(plan_.peers.size()),
      responders_(plan_.peers.size()),
      hosts_(plan_.bridges.size()) {
  for (std::size_t line = 0; line < plan_.lines.size(); ++line) lines_.push_back(&system_.add_line());
  for (std::size_t plc = 0; plc < plan_.plcs.size(); ++plc) add_plc(plc);
  for (std::size_t line = 0; line < plan_.lines.size(); ++line)
    for (const StationPlan& station : plan_.lines[line].stations) add_other(plan_.lines[line], *lines_[line], station);
  wire_sync();
  for (const EventPlan& event : plan_.events) system_.schedule(event.at, [this, &event] { carry_out(event); });
  askers_.resize(lines_.size());
  for (const Spot& spot : seen.spots) join(spot);
  for (const std::size_t line : seen.lines) {
    askers_[line].requester = &system_.add_requester(*lines_[line]);
    drive_sync(*askers_[line].requester, plan_, plan_.lines[line], responders_);
  }
}

Rig::~Rig() = default;

/// Lets a master join a line if there is room, and a host port if there is more.
void Rig::join(const Spot& spot) {
  serial::SharedLine& line = *lines_[spot.line];
  Asker& asker = askers_[spot.line];
  const std::size_t room = serial::Line::kDrivers - plan_.lines[spot.line].stations.size();
  if (!asker.requester && room > 0) {
    asker = {&system_.add_requester(line), room > 1 ? &system_.add_host_port(line) : nullptr, spot};
    drive_sync(*asker.requester, plan_, plan_.lines[spot.line], responders_);
  }
  simulations_.push_back(
      std::make_unique<serial::Simulation>(system_, line, *plcs_[spot.plc], spot.port, asker.requester, asker.host));
}

/// A port that is on no line of the plan is alone on one of its own.
void Rig::add_plc(std::size_t number) {
  const PlcPlan& plc = plan_.plcs[number];
  std::vector<serial::SharedLine*> at(plc.program->model->ports, nullptr);
  for (std::size_t line = 0; line < plan_.lines.size(); ++line)
    for (const StationPlan& station : plan_.lines[line].stations)
      if (station.kind == StationPlan::Kind::Plc && station.number == number) at[station.port] = lines_[line];
  for (serial::SharedLine*& line : at)
    if (!line) line = &system_.add_line();
  plcs_.push_back(&system_.add_plc(at, plc.program, plc.field));
}

/// Adds a peer or a bridge.
void Rig::add_other(const LinePlan& plan, serial::SharedLine& line, const StationPlan& station) {
  if (station.kind == StationPlan::Kind::Plc) return;
  const std::size_t number = station.number;
  if (station.kind == StationPlan::Kind::Bridge) {
    hosts_[number] = &system_.add_host_port(line);
    return;
  }
  const PeerPlan& peer = plan_.peers[number];
  if (peer.automaton) {
    responders_[number] = &system_.add_responder(line, peer.automaton->clone());
    return;
  }
  const StationPlan* const first = first_plc(plan);
  const auto format = [settings = plan.settings, plc = first ? plcs_[first->number] : nullptr,
                       port = first ? first->port : std::uint8_t{0}, without = format_without_s7200(plan_, plan)] {
    return settings.over(plc ? plc->line_format(port) : without);
  };
  pollers_[number] = &system_.add_poller(line, peer.polls, {.format = format, .verdict = verdict_on});
}

void Rig::wire_sync() {
  for (std::size_t peer = 0; peer < plan_.peers.size(); ++peer)
    if (const auto& sync = plan_.peers[peer].sync) system_.wire_sync(*plcs_[sync->plc], sync->point, *responders_[peer]);
}

void Rig::power_up() {
  system_.stop_when(stop_);
  for (std::size_t line = 0; line < lines_.size(); ++line) {
    if (const auto master = plan_.lines[line].master)
      lines_[line]->faults().set_master(driver_of(plan_.lines[line].stations[*master]));
    for (const FaultPlan& fault : plan_.lines[line].faults) inject(line, fault, 0);
    if (const auto seed = plan_.lines[line].contention) lines_[line]->line().leave_contention_to_chance(*seed);
  }
  for (std::size_t number = 0; number < plcs_.size(); ++number) {
    if (plan_.plcs[number].settings.starts == 0) {
      power_up_plc(number, 0);
      continue;
    }
    if (!sinks_[number].empty()) plcs_[number]->cpu().set_sink(&sinks_[number]);
    system_.power_off(*plcs_[number]);
  }
  for (std::size_t peer = 0; peer < pollers_.size(); ++peer)
    if (pollers_[peer]) pollers_[peer]->poller().start(plan_.peers[peer].polls.starts);
}

/// Gives a PLC power for the first time: the program begins with its memory, clock and assignments, and the sinks watch it.
void Rig::power_up_plc(std::size_t number, Time at) {
  serial::Plc& plc = *plcs_[number];
  const PlcSettings& settings = plan_.plcs[number].settings;
  FanOut& sinks = sinks_[number];
  if (plc.powered() && !sinks.empty()) plc.cpu().set_sink(&sinks);  // without sinks, another watcher may be set by now
  plc.cpu().set_clock_error(settings.clock_error);
  plc.power_up(kept_memory(number), at);
  if (settings.clock) plc.cpu().set_clock(*settings.clock);
  for (const Assignment& assignment : settings.set) assign(plc.cpu(), assignment);
}

bool Rig::has_begun(std::size_t plc) const {
  return plan_.plcs[plc].settings.starts == 0 || plcs_[plc]->powered() || plcs_[plc]->cpu().time() > 0;
}

void Rig::carry_out(const EventPlan& event) {
  using What = EventPlan::What;
  const Time now = system_.now();
  if (told_.emplace(now, &event).second) tell(event, now);  // an event that runs again is told once
  switch (event.what) {
    case What::PowerOff:
      return switch_power(event.station, false);
    case What::PowerOn:
      return switch_power(event.station, true);
    case What::Cut:
      lines_[event.line]->line().separate(now, beyond(event));
      break;
    case What::Mend:
      lines_[event.line]->line().separate(now, 0);
      break;
    case What::Set:
      if (!plcs_[event.plc]->powered()) break;
      for (const Assignment& assignment : event.set) assign(plcs_[event.plc]->cpu(), assignment);
      break;
    case What::Fault:
      inject(event.line, event.fault, now);
      break;
    case What::ClearFaults:
      lines_[event.line]->faults().clear(now);
      break;
  }
}

void Rig::tell(const EventPlan& event, Time at) {
  const bool is_set = event.what == EventPlan::What::Set;
  const std::string what = event_text(event, plan_, is_set && !plcs_[event.plc]->powered());
  for (const EventOnlooker& onlooker : system_onlookers_) onlooker(event, at, what);
  const auto tell_plc = [&](std::size_t plc, const std::string& said) {
    for (const Onlooker& onlooker : onlookers_) onlooker(plc, at, said);
  };
  const EventSubject subject = subject_of(event);
  if (subject.station) {
    if (subject.station->kind == StationPlan::Kind::Plc) tell_plc(subject.station->number, what);
    return;
  }
  const LinePlan& line = plan_.lines[subject.line];
  for (const StationPlan& station : line.stations)
    if (station.kind == StationPlan::Kind::Plc) tell_plc(station.number, fmt::format("line {}: {}", line.name, what));
}

void Rig::inject(std::size_t line, const FaultPlan& fault, Time now) {
  const int driver = fault.station ? driver_of(plan_.lines[line].stations[*fault.station]) : serial::Faults::kAnyDriver;
  lines_[line]->faults().inject(fault.fault, now, driver);
}

std::string Rig::station_at(std::size_t line, int driver) const {
  for (const StationPlan& station : plan_.lines[line].stations)
    if (driver_of(station) == driver) return name_of(plan_, station);
  return {};
}

std::optional<SerialFormat> Rig::format_of(const StationPlan& station) const {
  if (station.kind == StationPlan::Kind::Bridge) return {};
  if (station.kind == StationPlan::Kind::Plc) {
    const serial::Plc& plc = *plcs_[station.number];
    return plc.powered() ? std::optional(plc.line_format(station.port)) : std::nullopt;
  }
  const serial::ResponderStation* const responder = responders_[station.number];
  const serial::PollerStation* const poller = pollers_[station.number];
  const bool is_set = responder ? responder->powered() : poller->powered() && poller->poller().state().asked > 0;
  if (!is_set) return {};
  return responder ? responder->uart().state().format : poller->uart().state().format;
}

/// Switches the power of a station; it stays as it is if it is on or off already.
void Rig::switch_power(const StationPlan& station, bool on) {
  const Time now = system_.now();
  if (station.kind == StationPlan::Kind::Plc) {
    serial::Plc& plc = *plcs_[station.number];
    if (plc.powered() == on) return;
    if (!has_begun(station.number)) return power_up_plc(station.number, now);
    on ? system_.power_on(plc) : system_.power_off(plc);
  } else if (serial::ResponderStation* const responder = responders_[station.number]) {
    if (responder->powered() == on) return;
    on ? responder->power_on(now) : responder->power_off(now);
  } else {
    serial::PollerStation& poller = *pollers_[station.number];
    if (poller.powered() == on) return;
    on ? poller.power_on(now, now + plan_.peers[station.number].polls.starts) : poller.power_off(now);
  }
}

int Rig::driver_of(const StationPlan& station) const {
  switch (station.kind) {
    case StationPlan::Kind::Plc:
      return plcs_[station.number]->driver(station.port);
    case StationPlan::Kind::Peer:
      return responders_[station.number] ? responders_[station.number]->uart().driver()
                                         : pollers_[station.number]->uart().driver();
    case StationPlan::Kind::Bridge:
      return hosts_[station.number]->uart().driver();
  }
  return 0;
}

/// The drivers on the far side of a cut. Who has joined at a spot is beside the PLC there.
std::uint32_t Rig::beyond(const EventPlan& cut) const {
  const std::vector<StationPlan>& stations = plan_.lines[cut.line].stations;
  const auto bit = [](int driver) { return 1U << static_cast<unsigned>(driver); };
  std::uint32_t far = 0;
  for (std::size_t i = cut.near; i < stations.size(); ++i) {
    const StationPlan& station = stations[i];
    far |= bit(driver_of(station));
    const auto& [requester, host, spot] = askers_[cut.line];
    if (station.kind != StationPlan::Kind::Plc || spot.plc != station.number || spot.port != station.port) continue;
    if (requester) far |= bit(requester->uart().driver());
    if (host) far |= bit(host->uart().driver());
  }
  return far;
}

}  // namespace s7200::tools
