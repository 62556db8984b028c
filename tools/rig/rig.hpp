// PLCs with everything attached: what they have kept, what drives their inputs, what disturbs their lines, who else is on
// them, and what is recorded. Every verb and every test bench assembles them here, be it one PLC from the command line or a
// system from a file.
#pragma once

#include <functional>
#include <iosfwd>
#include <list>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "serial_sim/system/simulation.hpp"
#include "tools/host/written_files.hpp"
#include "tools/plan/system_plan.hpp"
#include "tools/rig/capture_files.hpp"
#include "tools/rig/plc_rig.hpp"

namespace s7200::tools {

class SystemTrace;

/// What a rig is told besides its plan.
struct RigSurroundings {
  std::string path{};                       ///< of the system file
  std::string link{};                       ///< a pty's link: nothing is written there, and no output may have its name
  std::ostream* standard_output = nullptr;  ///< `-` for a trace and the outputs
  std::string trace{};                      ///< of a system, all its PLCs in one file
  TraceDetail trace_detail = TraceDetail::Way;
  /// The spots from which callers look at the system, see simulation(). On each line a master stands beside the PLC of the
  /// first of its spots.
  std::vector<Spot> spots{};
  StopToken stop{};                  ///< ends what runs
  std::function<void()> begun{};     ///< told when all has been read, before files are written
  std::vector<std::size_t> lines{};  ///< without an S7-200: a master joins each of them, on the first part of a cut cable
};

class Rig final {
 public:
  /// Reads and opens all files that the plan and its surroundings name. Returns null with all `problems` if one of them
  /// cannot be opened; then no file has been changed.
  static std::unique_ptr<Rig> assemble(SystemPlan plan, const RigSurroundings& surroundings,
                                       std::vector<std::string>& problems);

  ~Rig();

  /// Every PLC begins with its memory, clock and assignments, at time 0 or when it starts, the lines with their faults, the
  /// records watch them, and every master asks its first request 1 s later or when it starts. All that runs ends early when
  /// the stop token of the surroundings asks for it.
  void power_up();

  serial::System& system() { return system_; }
  Time time() const { return system_.time(); }
  const SystemPlan& plan() const { return plan_; }

  /// The simulation as seen from one of the spots.
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

  /// The files that are read and written already.
  const WrittenFiles& files() const { return files_; }

  /// The sinks that watch a CPU; others may be added.
  FanOut& sinks(std::size_t plc = 0) { return std::next(plc_rigs_.begin(), static_cast<std::ptrdiff_t>(plc))->sinks(); }

  /// The memory with which a PLC powers up first; null if nothing was kept.
  const RetentiveMemory* kept_memory(std::size_t plc = 0) const {
    return std::next(plc_rigs_.begin(), static_cast<std::ptrdiff_t>(plc))->kept();
  }

  /// Writes the records so far to their files, for readers who follow a run in real time. A trace of a system is a second
  /// behind.
  void flush_records();

  /// Completes the records and keeps the memories of the PLCs that have had power. Returns what could not be written.
  std::vector<std::string> finish();

 private:
  Rig(SystemPlan plan, const RigSurroundings& surroundings);
  void add_plc(std::size_t number);
  void wire_sync();
  void tell(const EventPlan& event, Time at);
  bool has_begun(std::size_t plc) const;
  void switch_power(const StationPlan& station, bool on);
  void add_other(const LinePlan& plan, serial::SharedLine& line, const StationPlan& station);
  void join(const Spot& spot);
  void watch(std::size_t line, CaptureFiles& captures);
  void inject(std::size_t line, const FaultPlan& fault, Time now);
  int driver_of(const StationPlan& station) const;
  std::uint32_t beyond(const EventPlan& cut) const;
  bool claim_files(std::string& why);
  bool open_records(std::string& why);

  SystemPlan plan_;
  RigSurroundings surroundings_;
  WrittenFiles files_;
  std::unique_ptr<SystemTrace> trace_;  // null: none; outlives the system, as all records do
  std::list<PlcRig> plc_rigs_;
  std::list<CaptureFiles> captures_;  // by line
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
  std::set<std::pair<Time, const EventPlan*>> told_;  // by their places in the plan: two of one instant may read the same
};

}  // namespace s7200::tools
