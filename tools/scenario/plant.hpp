// A program in simulation, or a system, with all that watches it.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "interpreter/base/stop_token.hpp"
#include "interpreter/trace/fan_out.hpp"
#include "serial_sim/system/simulation.hpp"
#include "tools/coverage/observed.hpp"
#include "tools/rig/rig.hpp"
#include "tools/scenario/result.hpp"
#include "tools/scenario/scenario.hpp"
#include "tools/session/past/actions/journal.hpp"
#include "tools/session/past/seen_rig.hpp"
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

/// What is seen of one CPU.
struct Watch {
  Watch(const std::shared_ptr<const Program>& program, const Observed& observed)
      : timeline(program, nullptr), observers(program, observed) {
    sinks.add(&timeline);
    sinks.add(&interrupts);
    observers.add_to(sinks);
  }
  Timeline timeline;
  InterruptCounter interrupts;
  PlcObservers observers;
  FanOut sinks;
};

/// The scenario's system, of which one PLC at a time is looked at; without one, that of a program alone.
class Plant {
 public:
  /// Powered up, with what the head of the scenario sets. The scenario is not owned; `program` may be null if it has a
  /// system.
  Plant(const Scenario& scenario, std::shared_ptr<const Program> program, StopToken stop, const Observed& observed = {});

  /// Does it to the PLC that is looked at, as a programming device or the plant around it does.
  void act(Action action);

  /// Is told of what a step is about to do itself to the PLC that is looked at.
  void note(Action action) {
    if (journal_) journal_->note(std::move(action), plc_number());
  }

  /// What has been done, a recording for each power-up, the last one up to now. Nothing of a system with a PLC that is asked
  /// on two lines where no other one is.
  std::vector<Recording> recordings() const;

  /// From which it is looked at, and where masters ask.
  const std::vector<Spot>& spots() const { return spots_; }

  /// Where that stands now; nothing without recordings, and where more has been done than they keep.
  std::optional<PlaceInRun> place() const;

  /// How a History sees what is to be played again: by PLC, and what it knows by name.
  std::vector<serial::Simulation*> stations() const { return seen_->stations(); }
  History::Settings history_settings() { return tools::history_settings(*rig_); }

  /// Of those stations, the one from which the line that is looked at is seen.
  std::size_t station_on_line() const { return seen_->station_on(spots_[here_].line).value_or(plc_number()); }

  /// What follows is about that PLC of the system, and a master on that line.
  void look_at(const Spot& spot);

  /// Does it to the system, now.
  void carry_out(const EventPlan& event);

  /// Power goes off, and comes back after `power_off`: the clock goes on, and memory is kept unless it is lost. Of a
  /// program.
  void power_cycle(bool memory_lost, Time power_off);

  /// Runs to where the first step may begin. Returns false if that never comes.
  bool get_ready();

  void begin_exchange();
  void end_exchange();

  /// Unlike a request, what is only waited for begins nothing that interrupts are counted from.
  void begin_reception();

  /// Returns false if they do not come within a minute.
  bool wait_scans(std::uint64_t count);

  /// Runs scan by scan until `holds`. Returns false if it does not when the time is over or the CPU is in STOP.
  bool wait_until(const std::function<bool()>& holds, Time timeout);

  serial::Simulation& simulation() const { return rig_->simulation(here_); }
  Cpu& cpu() const { return simulation().cpu(); }
  Slave& slave() { return *slaves_[here_]; }
  SerialFormat format() const { return slaves_[here_]->format(); }

  /// Since the last request began, or since power-up.
  const InterruptCounter& interrupts() const { return watches_[plc_number()]->interrupts; }

  /// What the CPUs on the line did in that exchange.
  std::string timeline(const serial::Exchange& exchange) const;

  /// `\n` and the errors of the CPU, a line each; empty if there are none.
  std::string why_stopped() { return why_stopped(plc_number()); }
  std::string why_stopped(std::size_t plc) const;

  /// Adds what was tried of its programs so far, and where their time went, if that is observed.
  void report(CoverageOfPrograms& coverage, ProfileOfPrograms& profile) const;

  std::size_t plcs() const { return watches_.size(); }
  std::size_t plc_number() const { return spots_[here_].plc; }
  std::string name_of(std::size_t plc) const { return plan_.plcs[plc].name; }
  /// `VW20`, and of a system `VW20 of slave`, the PLC that is looked at.
  std::string of_plc(const std::string& what) const;
  bool is_in_stop(std::size_t plc) const;

  /// Of the CPU that is looked at.
  bool has_power() const { return is_powered(plc_number()); }

  /// Since the first power-up.
  Time time() const { return before_ + simulation().time(); }

 private:
  void power_up();
  void begin_journal();
  /// The CPU does not pause at the ends of its scans any more, and is not paused at the last: no time passes.
  void leave_pause();
  serial::MasterSettings master_of(const Spot& spot) const;
  const Cpu& cpu_of(std::size_t plc) const { return rig_->plc(plc).cpu(); }
  bool is_on(std::size_t line, std::size_t plc) const;
  bool is_powered(std::size_t plc) const { return rig_->plc(plc).powered(); }

  const Scenario& scenario_;
  StopToken stop_;
  SystemPlan plan_;                              // with which it is powered up next
  std::vector<std::unique_ptr<Watch>> watches_;  // by PLC; outlive who is watched
  std::unique_ptr<Rig> rig_;
  std::vector<Spot> spots_;                              // from which it is looked at
  std::vector<std::unique_ptr<SimulatedSlave>> slaves_;  // by spot
  std::size_t here_ = 0;                                 // the spot
  std::optional<SeenRig> seen_;
  std::optional<Journal> journal_;     // since the last power-up
  std::vector<Recording> recordings_;  // what was before that
  Time before_ = 0;                    // what had passed at the last power cycle
};

}  // namespace s7200::tools
