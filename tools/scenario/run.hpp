// A scenario that is being run, as its steps see it.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>

#include "tools/scenario/plant.hpp"
#include "tools/scenario/runner.hpp"
#include "tools/slave/slave_in_rig.hpp"

namespace s7200::tools {

class Run {
 public:
  Run(const Scenario& scenario, const Bench& bench);

  /// Runs it, once.
  ScenarioResult result();

  // --- what steps look at ---

  const Scenario& scenario() const { return scenario_; }

  /// The program in simulation; null on any other slave, where only steps that need no more than the line get to act.
  Plant* plant() { return plant_.get(); }

  Slave& slave() { return plant_ ? plant_->slave() : own_ ? *own_ : *bench_.slave; }

  /// Then its times are exact.
  bool in_simulation() const { return plant_ || own_; }

  /// Does it to the system, now.
  void carry_out(const EventPlan& event) { plant_ ? plant_->carry_out(event) : lines_->carry_out(event); }

  /// Of the line, as it is now.
  SerialFormat format() const { return plant_ ? plant_->format() : own_ ? own_->format() : bench_.format; }

  /// When the scenario began on the slave's clock: `at` counts from there.
  Time begin() const { return begin_; }

  /// By how much `at` and `wait: until` may be missed: each answer since power-up may have come later by the tolerance.
  Time allowed_delay() const { return allowed_delay_; }
  void allow_delay() { allowed_delay_ += scenario_.tolerance; }
  void forget_delay() { allowed_delay_ = 0; }

  /// The exchange before, if there was one since power-up.
  struct Before {
    std::optional<Time> end{};
    std::string remark{};  ///< what its request met
  };
  Before before{};

  // --- what they report ---

  /// This step expected something, and that is judged.
  void count_check() { ++result_.checks; }

  void add(Finding finding);

  /// The same of an exchange, with what the CPU did in it, if that can be seen and is shown.
  void add_exchange(Finding finding);

  /// What went over the line in this step.
  void keep(const serial::Exchange& exchange);

  /// This slave cannot be asked so.
  void skip_step() { ++result_.skipped_steps; }

  /// The way to the slave broke: the scenario ends.
  void lose_slave(const std::string& why);

  /// On a slave outside simulation, something about times could not be judged.
  void leave_times_unjudged() { times_unjudged_ = true; }

  /// Of a step with many exchanges: the one that comes now.
  void begin_turn(std::size_t turn) { turn_ = turn; }

  /// False once nothing more is to be done: after an interruption, or without the slave.
  bool goes_on() const;

  /// The mode in which the CPU that is looked at may end.
  void expect_mode(std::optional<Mode> mode) {
    if (mode)
      modes_expected_.insert(plant_->plc_number());
    else
      modes_expected_.erase(plant_->plc_number());
  }

 private:
  void join_lines();
  void do_step(const Step& step);
  std::string acted_inside() const;
  void look_at_mode();
  void settle_outcome();

  const Scenario& scenario_;
  const Bench& bench_;
  std::unique_ptr<Plant> plant_;
  std::unique_ptr<SlaveInSimulation> own_;  ///< that the bench made, or the lines of a system without an S7-200
  SlaveInRig* lines_ = nullptr;             ///< those lines; null if the scenario is about something else
  std::size_t step_ = 0, turn_ = 0;
  Time begin_ = 0, allowed_delay_ = 0;
  bool lost_ = false;                     ///< the slave
  bool times_unjudged_ = false;           ///< on a slave outside simulation
  std::set<std::size_t> modes_expected_;  ///< of which PLCs
  ScenarioResult result_;
};

/// Adds to what was found, or expected, after a comma.
void add_remark(std::string& words, std::string_view remark);

}  // namespace s7200::tools
