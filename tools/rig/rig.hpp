// PLCs with everything attached: what they have kept, what drives their inputs, what disturbs their lines, and who else is
// on them. Every verb, every test bench and every page assembles them here, be it one PLC from the command line or a system
// from a file. A rig touches no file: recorded_rig.hpp does.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "interpreter/base/stop_token.hpp"
#include "interpreter/trace/fan_out.hpp"
#include "serial_sim/system/simulation.hpp"
#include "tools/plan/system_plan.hpp"

namespace s7200::tools {

/// From where a rig is looked at.
struct RigSpots {
  /// See simulation(). On each line a master stands beside the PLC of the first of its spots.
  std::vector<Spot> spots{};
  std::vector<std::size_t> lines{};  ///< without an S7-200: a master joins each of them, on the first part of a cut cable
};

class Rig {
 public:
  Rig(SystemPlan plan, const RigSpots& seen);
  virtual ~Rig();
  Rig(const Rig&) = delete;
  Rig& operator=(const Rig&) = delete;

  /// All that runs from power_up() on ends early when this asks for it.
  void stop_when(StopToken stop) { stop_ = std::move(stop); }

  /// Every PLC begins with its memory, clock and assignments, at time 0 or when it starts, the lines with their faults, and
  /// every master asks its first request 1 s later or when it starts.
  void power_up();

  serial::System& system() { return system_; }
  Time time() const { return system_.time(); }
  const SystemPlan& plan() const { return plan_; }

  /// The simulation as seen from one of the spots.
  bool has_simulation() const { return !simulations_.empty(); }
  serial::Simulation& simulation(std::size_t spot = 0) { return *simulations_[spot]; }
  const serial::Simulation& simulation() const { return *simulations_.front(); }
  const Cpu& cpu() const { return simulation().cpu(); }

  /// The master that has joined the line; null if there is none.
  serial::RequesterStation* requester(std::size_t line) { return askers_[line].requester; }

  serial::Plc& plc(std::size_t number) { return *plcs_[number]; }
  const serial::Plc& plc(std::size_t number) const { return *plcs_[number]; }
  serial::SharedLine& line(std::size_t number) { return *lines_[number]; }
  const serial::Faults& faults(std::size_t line) const { return lines_[line]->faults(); }
  /// The name of the station with that driver; empty if the plan does not have it.
  std::string station_at(std::size_t line, int driver) const;
  /// Returns null if the peer is not a master.
  const serial::Poller* poller(std::size_t peer) const { return pollers_[peer] ? &pollers_[peer]->poller() : nullptr; }
  serial::HostPort& host_port(std::size_t bridge) { return hosts_[bridge]->port(); }

  /// The format of a station's port; nothing for one without power, for a master that has not asked yet, and for a bridge.
  std::optional<SerialFormat> format_of(const StationPlan& station) const;

  /// Carries out an event now.
  void carry_out(const EventPlan& event);

  /// An onlooker is told, in words, what is done to a PLC and its lines.
  using Onlooker = std::function<void(std::size_t plc, Time at, const std::string& what)>;
  void tell_of_events(Onlooker onlooker) { onlookers_.push_back(std::move(onlooker)); }

  /// An event is told, in words, to whoever looks at the system as a whole.
  using EventOnlooker = std::function<void(const EventPlan& event, Time at, const std::string& what)>;
  void tell_of_system(EventOnlooker onlooker) { system_onlookers_.push_back(std::move(onlooker)); }

  /// The sinks that watch a CPU; others may be added.
  FanOut& sinks(std::size_t plc = 0) { return sinks_[plc]; }

  /// The memory with which a PLC powers up first; null if nothing was kept.
  const RetentiveMemory* kept_memory(std::size_t plc = 0) const {
    const auto& kept = plan_.plcs[plc].kept;
    return kept ? &*kept : nullptr;
  }

 protected:
  SystemPlan plan_;

  /// Whether it has had power. Until then it has read nothing of what it is to begin with.
  bool has_begun(std::size_t plc) const;
  /// Another PLC of a line, by its number among the peers; null if the peer is a master.
  serial::ResponderStation* responder(std::size_t peer) { return responders_[peer]; }

 private:
  void power_up_plc(std::size_t number, Time at);
  void add_plc(std::size_t number);
  void wire_sync();
  void tell(const EventPlan& event, Time at);
  void switch_power(const StationPlan& station, bool on);
  void add_other(const LinePlan& plan, serial::SharedLine& line, const StationPlan& station);
  void join(const Spot& spot);
  void inject(std::size_t line, const FaultPlan& fault, Time now);
  int driver_of(const StationPlan& station) const;
  std::uint32_t beyond(const EventPlan& cut) const;

  StopToken stop_{};
  std::vector<FanOut> sinks_;  // by PLC; they outlive the system
  serial::System system_;
  std::vector<serial::SharedLine*> lines_;
  std::vector<serial::Plc*> plcs_;
  std::vector<serial::PollerStation*> pollers_;        // by peer
  std::vector<serial::ResponderStation*> responders_;  // by peer
  std::vector<serial::HostStation*> hosts_;            // by bridge
  struct Asker {
    serial::RequesterStation* requester = nullptr;  // null if there is no place for one
    serial::HostStation* host = nullptr;            // null if there is no place for one
    Spot spot{};
  };
  std::vector<Asker> askers_;                                     // by line
  std::vector<std::unique_ptr<serial::Simulation>> simulations_;  // by spot
  std::vector<Onlooker> onlookers_;
  std::vector<EventOnlooker> system_onlookers_;
  std::set<std::pair<Time, const EventPlan*>> told_;  // by their places in the plan: two of one instant may read the same
};

}  // namespace s7200::tools
