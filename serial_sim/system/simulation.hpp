// The system that most programs need: one line, and on it a PLC, a requester (the master) and a port for the host. If the
// PLC has two ports, the other one is alone on a line of its own, unless the system was built by the caller.
#pragma once

#include <atomic>
#include <functional>
#include <memory>

#include "interpreter/base/stop_token.hpp"
#include "serial_sim/system/system.hpp"

namespace s7200::serial {

class Simulation {
 public:
  /// `port` is the PLC's port that is on the line with the others.
  explicit Simulation(std::shared_ptr<const Program> program, FieldScript field = {}, std::uint8_t port = 0);

  /// A view of a system that the caller has built, from a PLC's port and its line: `master` and `host` are null if there is
  /// none. Nothing is owned.
  Simulation(System& system, SharedLine& line, Plc& plc, std::uint8_t port, RequesterStation* master, HostStation* host);

  /// Each run ends early once `request` asks for it; it is asked every 100 ms.
  void stop_when(StopToken request) { system_->stop_when(request); }
  bool stop_requested() const { return system_->stop_requested(); }

  /// Powers the CPU up into RUN, at time 0, with what its memory has kept.
  void power_up(const RetentiveMemory* memory = nullptr) { plc_->power_up(memory); }

  /// Runs the CPU and handles events until its clock has reached `end`. A CPU that goes to STOP ends the run if it is the
  /// only one.
  Halt run_until(Time end);

  /// Lets the master's format follow the port's from now on, through `of`. It changes at once, but not within an exchange:
  /// frames that the program sends unasked are heard as well as its answers.
  void let_master_follow(std::function<SerialFormat(const SerialFormat& port)> of);

  /// Runs on, in STOP too, until a started exchange of the master, or its listening, is over. The master is busy still if a
  /// stop was asked for.
  const Exchange& finish_exchange() { return system_->finish_exchange(*master_); }

  /// Whether the line has had no character on it for `quiet` up to now.
  bool line_quiet_for(Time quiet) const { return time() - last_activity() >= quiet; }

  /// End of the last character that anyone sent or heard.
  Time last_activity() const { return line_->last_activity(); }

  /// Runs until the first scan has ended and the line has been quiet since then for `quiet`. `quiet` is called only after
  /// that scan, in which programs set the rate of their port. Returns false if `limit` came first, the CPU stopped, or a
  /// stop was asked for.
  bool run_until_ready(const std::function<Time()>& quiet, Time limit);
  bool run_until_ready(Time quiet, Time limit) {
    return run_until_ready([quiet] { return quiet; }, limit);
  }

  /// Injects a fault now. Several faults may be at work at once.
  void inject(const Fault& fault) { line_->faults().inject(fault, time()); }
  void clear_faults() { line_->faults().clear(time()); }  ///< and every disturbance of the line, whoever made it
  const Faults& faults() const { return line_->faults(); }

  System& system() { return *system_; }
  Plc& plc() { return *plc_; }
  const Plc& plc() const { return *plc_; }
  const SharedLine& line() const { return *line_; }
  Cpu& cpu() { return plc_->cpu(); }
  const Cpu& cpu() const { return plc_->cpu(); }
  bool has_master() const { return master_ != nullptr; }
  Requester& master() { return master_->requester(); }
  const Requester& master() const { return master_->requester(); }
  Uart& master_uart() { return master_->uart(); }
  const Uart& master_uart() const { return master_->uart(); }
  /// Sets the master's format from its next character on, in either direction.
  void configure_master(const SerialFormat& format) { master_uart().configure(format, time()); }
  bool has_host_port() const { return host_ != nullptr; }
  HostPort& host_port() { return host_->port(); }
  const HostPort& host_port() const { return host_->port(); }
  Time time() const { return system_->time(); }

  /// The format that the program has set its port to; that of PPI until the program has switched it to Freeport mode.
  SerialFormat port_format() const { return plc_->port_format(port_); }

  /// The PLC's port on the line: its number, and what it is doing.
  std::uint8_t port() const { return port_; }
  const Freeport& freeport() const { return cpu().state().port[port_]; }

  /// Lets `sink` watch the line from now on; null ends that. Not owned. After restore() it sees time go back.
  void set_wire_sink(WireSink* sink) { plc_->set_wire_sink(sink, port_); }

  using Snapshot = System::Snapshot;
  Snapshot snapshot() const { return system_->snapshot(); }
  void restore(const Snapshot& snapshot) { system_->restore(snapshot); }

 private:
  std::vector<SharedLine*> lines(const CpuModel& model);

  std::unique_ptr<System> own_;  // null if the caller has built the system
  System* system_;
  std::uint8_t port_;
  SharedLine* line_;
  Plc* plc_;
  RequesterStation* master_;  // null if the line has no master
  HostStation* host_;         // null if the line has no host port
};

}  // namespace s7200::serial
