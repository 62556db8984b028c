// A program in simulation with all that watches it.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>

#include "interpreter/trace/fan_out.hpp"
#include "serial_sim/system/simulation.hpp"
#include "tools/scenario/scenario.hpp"
#include "tools/slave/simulated_slave.hpp"
#include "tools/views/timeline.hpp"

namespace s7200::tools {

/// How often something happened since begin().
class InterruptCounter final : public TraceSink {
 public:
  void begin() { *this = {}; }
  std::uint64_t of_routine(std::uint8_t number) const { return routine_[number]; }
  std::uint64_t of_event(std::uint8_t number) const { return event_[number]; }
  std::uint64_t lost() const { return lost_; }

  void record(const TraceRecord& record) override;
  bool wants_scans() const override { return false; }

 private:
  std::array<std::uint64_t, 256> routine_{}, event_{};
  std::uint64_t lost_ = 0;
};

class Plant {
 public:
  /// Powered up, with what the head of the scenario sets. The scenario is not owned.
  Plant(const Scenario& scenario, std::shared_ptr<const Program> program);

  /// Power goes off, and comes back after `power_off`: the clock goes on, and memory is kept unless it is lost.
  void power_cycle(bool memory_lost, Time power_off);

  /// Runs to where the first step may begin. Returns false if that never comes.
  bool get_ready();

  void begin_exchange();
  void end_exchange() { timeline_.end(); }

  /// Unlike a request, what is only waited for begins nothing that interrupts are counted from.
  void begin_reception() { timeline_.begin(); }

  /// Returns false if they do not come within a minute.
  bool wait_scans(std::uint64_t count);

  /// Runs scan by scan until `holds`. Returns false if it does not when the time is over or the CPU is in STOP.
  bool wait_until(const std::function<bool()>& holds, Time timeout);

  serial::Simulation& simulation() { return *simulation_; }
  Cpu& cpu() { return simulation_->cpu(); }
  Slave& slave() { return *slave_; }
  SerialFormat format() const { return scenario_.line.over(simulation_->port_format()); }
  const InterruptCounter& interrupts() const { return interrupts_; }  ///< since the last request began, or since power-up

  /// What the CPU did in that exchange.
  std::string timeline(const serial::Exchange& exchange) const;

  /// `\n` and the errors of the CPU, a line each; empty if there are none.
  std::string why_stopped();

  /// Since the first power-up.
  Time time() const { return before_ + simulation_->time(); }

 private:
  void power_up(const RetentiveMemory* memory);

  const Scenario& scenario_;
  std::shared_ptr<const Program> program_;
  Timeline timeline_;
  InterruptCounter interrupts_;
  FanOut sinks_;
  std::unique_ptr<serial::Simulation> simulation_;
  std::unique_ptr<SimulatedSlave> slave_;
  Time before_ = 0;  ///< what had passed at the last power cycle
};

}  // namespace s7200::tools
