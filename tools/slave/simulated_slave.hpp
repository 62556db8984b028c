// The slave that a program is, in simulation.
#pragma once

#include <functional>
#include <string>
#include <utility>

#include "serial_sim/system/simulation.hpp"
#include "tools/slave/slave.hpp"

namespace s7200::tools {

/// The longest wait after power-up: by then the line is quiet and awaited scans have come, or they never do.
inline constexpr Time kReadyWithin = 60 * kSecond;

/// Time passes only while it is used. The master's format follows the port of the program, as far as the options leave it
/// open, but not within an exchange.
class SimulatedSlave final : public SlaveInSimulation {
 public:
  /// The simulation is not owned and has been powered up. `name` is its program's. `in_stop_too`: a request is answered when
  /// the CPU is in STOP as well, as the CPU itself does in PPI.
  SimulatedSlave(serial::Simulation& simulation, const serial::MasterSettings& master, std::string name,
                 bool in_stop_too = false);

  /// `told` is called before each request, with the format in which it is sent.
  void when_asked(std::function<void(const SerialFormat& format, const serial::Request& request)> told) {
    asked_ = std::move(told);
  }

  /// Runs until the first scan has ended and the line has been quiet for pause(). False if that has not come by `limit`, or
  /// the CPU stopped and does not answer there.
  bool get_ready(Time limit);

  /// Runs until the first scan has ended and the line has been quiet for as long as a master leaves it, or until `after` if
  /// that is not kNever. Returns false when the CPU stopped and nothing answers there, after Ctrl-C, and, with `why` set,
  /// when the moment never comes.
  bool wait_until_ready(Time after, std::string& why);

  /// A note if the program has not switched its port to Freeport mode by now, or has where PPI is wanted; otherwise empty.
  std::string note_on_port(bool wants_freeport = true) const;

  /// Runs an exchange, on a CPU in STOP too. After Ctrl-C the result is its part so far, and no further exchange can begin.
  /// Throws std::invalid_argument for a byte with wrong parity in a format without parity.
  serial::Exchange exchange(const serial::Request& request) override;
  serial::Exchange receive(const serial::Listening& listening) override;
  /// Waits, in STOP too, but for a fatal error: the others on the line go on.
  void wait(Time duration) override;
  Time now() const override { return simulation_.time(); }
  bool stop_requested() const override { return simulation_.stop_requested(); }
  std::string name() const override { return name_; }
  std::string remark() const override { return remark_; }
  SerialFormat format() const override { return master_.over(simulation_.port_format()); }

  /// The pause that a master leaves between an answer and its next request, in the present format.
  Time pause() const override;

 private:
  bool run_until(Time end);
  bool run_ready_until(Time end);
  bool goes_on_in_stop() const;

  serial::Simulation& simulation_;
  serial::MasterSettings master_;
  std::string name_;
  std::string remark_;
  std::function<void(const SerialFormat&, const serial::Request&)> asked_{};
  bool in_stop_too_;
};

}  // namespace s7200::tools
