// A system of several PLCs with everything attached: what system_plan.hpp says, built.
#pragma once

#include <functional>
#include <list>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "serial_sim/system/system.hpp"
#include "tools/host/written_files.hpp"
#include "tools/rig/capture_files.hpp"
#include "tools/rig/plc_rig.hpp"
#include "tools/rig/system_plan.hpp"

namespace s7200::tools {

class SystemRig final {
 public:
  /// Opens all that the plan names. Null, and what is wrong, if something cannot be had; no file has been touched then.
  /// `path` is that of the system file. Signals are only noted from here on: there is something to complete.
  static std::unique_ptr<SystemRig> assemble(SystemPlan plan, const std::string& path, std::vector<std::string>& problems);

  /// Time 0: every PLC is switched on, every master asks its first request a scan or two later.
  void power_up();

  /// Runs until all clocks have reached `end`, and does what the plan says in between.
  void run_until(Time end);

  serial::System& system() { return system_; }
  const SystemPlan& plan() const { return plan_; }

  const serial::Plc& plc(std::size_t number) const { return *plcs_[number]; }
  const serial::Faults& faults(std::size_t line) const { return lines_[line]->faults(); }
  /// Null if the peer is no master.
  const serial::Poller* poller(std::size_t peer) const { return pollers_[peer] ? &pollers_[peer]->poller() : nullptr; }

  serial::SharedLine& line(std::size_t number) { return *lines_[number]; }
  serial::HostPort& host_port(std::size_t bridge) { return hosts_[bridge]->port(); }

  /// Of a line, the first PLC along the cable; null if there is none.
  const StationPlan* first_plc(const LinePlan& line) const;

  /// Completes the records and keeps the memories. Returns what could not be written.
  std::vector<std::string> finish();

 private:
  explicit SystemRig(SystemPlan plan);
  void add_plc(std::size_t number);
  void add_other(const LinePlan& plan, serial::SharedLine& line, const StationPlan& station);
  int driver_of(const StationPlan& station) const;
  void carry_out(const EventPlan& event);
  std::uint32_t beyond(const EventPlan& cut) const;
  bool claim_files(const std::string& path, std::string& why);
  bool open_records(std::string& why);

  SystemPlan plan_;
  WrittenFiles files_;
  std::list<PlcRig> plc_rigs_;
  std::list<CaptureFiles> captures_;  // by line; outlive the system
  serial::System system_;
  std::vector<serial::SharedLine*> lines_;
  std::vector<serial::Plc*> plcs_;
  std::vector<serial::PollerStation*> pollers_;  // by peer
  std::vector<const serial::Uart*> peer_uarts_;  // by peer
  std::vector<serial::HostStation*> hosts_;      // by bridge
  std::size_t next_event_ = 0;                   // of the plan
};

/// Runs to `end`; `progress` is told now and then. Returns why it ended: `time` or `interrupted`.
std::string_view run(SystemRig& rig, Time end, const std::function<void()>& progress);

}  // namespace s7200::tools
