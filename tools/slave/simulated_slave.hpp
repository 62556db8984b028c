// The slave that a program is, in simulation.
#pragma once

#include <string>

#include "interpreter/base/result.hpp"
#include "serial_sim/system/simulation.hpp"
#include "tools/slave/master_in_simulation.hpp"

namespace s7200::tools {

/// The longest wait after power-up: by then the line is quiet and awaited scans have come, or they never do.
inline constexpr Time kReadyWithin = 60 * kSecond;

/// Time passes only while it is used. The master's format follows the port of the program, as far as the options leave it
/// open, but not within an exchange.
class SimulatedSlave final : public MasterInSimulation {
 public:
  /// The simulation is not owned and has been powered up. `name` is its program's. `in_stop_too`: a request is answered when
  /// the CPU is in STOP as well, as the CPU itself does in PPI.
  SimulatedSlave(serial::Simulation& simulation, const serial::MasterSettings& master, std::string name,
                 bool in_stop_too = false);

  /// Runs until the first scan has ended and the line has been quiet for pause(). False if that has not come by `limit`, or
  /// the CPU stopped and does not answer there.
  bool get_ready(Time limit);

  /// Runs until the first scan has ended and the line has been quiet for as long as a master leaves it, or until `after` if
  /// that is not kNever. Trouble with nothing to say when the CPU stopped and nothing answers there, and after Ctrl-C; and
  /// when the moment never comes.
  Result<> wait_until_ready(Time after);

  /// A note if the program has not switched its port to Freeport mode by now, or has where PPI is wanted; otherwise empty.
  std::string note_on_port(bool wants_freeport = true) const;

  /// Waits, in STOP too, but for a fatal error: the others on the line go on.
  void wait(Time duration) override;
  Time now() const override { return simulation_.time(); }
  bool stop_requested() const override { return simulation_.stop_requested(); }
  SerialFormat format() const override { return master_.over(simulation_.port_format()); }

 private:
  serial::Requester& requester() override { return simulation_.master(); }
  void configure(const SerialFormat& format) override { simulation_.configure_master(format); }
  serial::Exchange run_exchange() override { return simulation_.finish_exchange(); }
  bool run_until(Time end);
  bool run_ready_until(Time end);
  bool goes_on_in_stop() const;

  serial::Simulation& simulation_;
  serial::MasterSettings master_;
  bool in_stop_too_;
};

}  // namespace s7200::tools
