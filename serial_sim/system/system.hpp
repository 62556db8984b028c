// Lines and the stations on them, in one time.
//
// Time. Each CPU has a clock of its own, which stands at the start of its next instruction; what an instruction does to the
// outside carries its end. CPUs know of one another only by what is on a line, and they touch a line only by events: what a
// CPU does to its port is an event at its instant. The rule that keeps all in one time:
//
//   Nothing happens before the horizon: the earliest of all events, and of the instants when a CPU may act. A CPU runs to
//   its own next event, or to the horizon and as long after it as a character takes that another might begin there,
//   whichever is first. An event is handled when no clock stands before it, and before any CPU that it is for executes an
//   instruction that starts after it.
//
// A CPU may act whenever it executes its program, and at the end of a system's part of its scan: until then only an event
// can make it act. CPUs run one after the other, each for most of a character, and which one is first does not matter: the
// order of events follows from their instants alone. It is the same in one run or in slices, traced or not. With one PLC
// there is no one to run ahead of, and it stops at every event, so that whoever looks finds all at the same instant.
// During a run nobody looks: then events of others are handled before it while it is known to do nothing but the same scan.
//
// In step. Who looks at several CPUs between two instructions has them run in step: none ahead of another one, and all stop
// at every event. Their instructions then come in the order of the instants at which they start, and of the numbers of the
// PLCs at the same instant. What is computed is the same, only slower.
#pragma once

#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "interpreter/base/stop_token.hpp"
#include "serial_sim/system/dispatcher.hpp"
#include "serial_sim/system/plc.hpp"
#include "serial_sim/system/shared_line.hpp"
#include "serial_sim/system/stations.hpp"

namespace s7200::serial {

/// The reason why a run has returned.
enum class Halt : std::uint8_t {
  Time,     ///< the end was reached
  Paused,   ///< a trace sink stopped a CPU, or a scan ended and a pause was asked for
  Stopped,  ///< the CPU of a Simulation is in STOP for good: not by a master, who may start it again. A System goes
            ///< on, for the sake of its other stations
  Request,  ///< a stop was asked for, see stop_when()
};

class System {
 public:
  System() = default;
  System(const System&) = delete;
  System& operator=(const System&) = delete;

  /// Lines and stations live as long as the system. A PLC comes before anything runs. Time is what the clocks of the CPUs
  /// say; without any it goes from event to event.
  SharedLine& add_line();
  Plc& add_plc(std::span<SharedLine* const> lines, std::shared_ptr<const Program> program, FieldScript field = {});
  /// Adds a PLC with its port 0 on `line`; a second port is alone on a line of its own.
  Plc& add_plc(SharedLine& line, std::shared_ptr<const Program> program, FieldScript field = {});
  RequesterStation& add_requester(SharedLine& line);
  HostStation& add_host_port(SharedLine& line);
  PollerStation& add_poller(SharedLine& line, PollPlan plan, Poller::Wiring wiring);
  ResponderStation& add_responder(SharedLine& line, std::unique_ptr<Automaton> automaton);

  /// An output of a PLC drives the sync signal beside a line, as a responder there sees it. Before anything runs.
  void wire_sync(Plc& from, const OutputPoint& output, ResponderStation& to);

  /// Each run ends early once `request` asks for it; it is asked every 100 ms.
  void stop_when(StopToken request) { stop_request_ = request; }
  bool stop_requested() const { return stop_request_.stop_requested(); }

  /// Lets CPUs run in step from now on, or ahead of each other.
  void run_in_step(bool on) { in_step_ = on; }

  /// Powers up all PLCs, as new. Plc::power_up() does so for one, before anything runs.
  void power_up();

  /// The power of one PLC goes off, or comes back, now(). Its CPU completes an instruction that it has begun, but does
  /// nothing more to the outside. Peers have calls of their own: ResponderStation, PollerStation.
  void power_off(Plc& plc);
  void power_on(Plc& plc);

  /// Schedules an action from outside at `at`, which is now() then: power, cables, faults, inputs. A CPU that is in the
  /// middle of an instruction completes it, and sees the effect after it. Actions happen in the order of their instants,
  /// before anything runs.
  void schedule(Time at, std::function<void()> deed);

  /// Calls `watcher` before and after each of these actions with its number; an empty function ends that. Wiring, not state.
  void watch_schedule(std::function<void(std::size_t number, bool done)> watcher) { watcher_ = std::move(watcher); }

  /// Whether any action is scheduled, or was.
  bool has_schedule() const { return !schedule_.empty(); }

  /// The number of events that have been handled: the cost of a run, whatever the host.
  std::uint64_t events_handled() const { return events_.handled(); }

  /// The number of PLCs.
  std::size_t plcs() const { return plcs_.size(); }

  /// The earliest clock of the CPUs that have power: nothing more happens before it.
  Time time() const {
    Time earliest = kNever;
    for (const auto& plc : plcs_)
      if (plc->powered()) earliest = std::min(earliest, plc->cpu().time());
    return earliest == kNever ? clock_ : earliest;
  }

  /// The instant of the scheduled action while it is being done, else time().
  Time now() const { return doing_at_ == kNever ? time() : doing_at_; }

  /// Whether a CPU was paused when it last ran.
  bool paused() const;

  /// Lets each CPU run once, to `end` at most, and handles the events due then. Returns Halt::Time if there is more to do.
  Halt step(Time end);

  /// Runs until all clocks have reached `end`.
  Halt run_until(Time end);

  /// Runs until a started exchange, or listening, is over. It is busy still if a CPU was paused or a stop was asked for.
  const Exchange& finish_exchange(const RequesterStation& station);

  struct Snapshot {
    std::vector<EventQueue> queues;
    std::vector<SharedLine::State> lines;
    std::vector<Plc::State> plcs;
    std::vector<RequesterStation::State> requesters;
    std::vector<HostStation::State> host_ports;
    std::vector<ResponderStation::State> responders{};
    std::vector<PollerStation::State> pollers{};
    Time clock = 0;  ///< while no CPU has power
    std::size_t done = 0;
    bool operator==(const Snapshot&) const = default;
  };
  Snapshot snapshot() const;

  /// Restores a snapshot of this system, or of one with the same lines and stations.
  void restore(const Snapshot& snapshot);

 private:
  template <class Part>
  using Parts = std::vector<std::unique_ptr<Part>>;

  /// Runs a step; `next_event` is the instant of the next events, before the step and after it.
  Halt step(Time end, Time& next_event);
  Time horizon() const;
  bool any_powered() const;
  const Cpu* run_cpus(Time end);
  const Cpu* run_one(Time end);
  const Cpu* run_each(Time end);
  const Cpu* run_next(Time end);
  const Cpu* come_to(Time now);
  Time next_action_besides(const Plc& plc) const;
  void do_scheduled();
  void look_at_next_scheduled() { next_scheduled_ = done_ < schedule_.size() ? schedule_[done_].at : kNever; }
  Time handle_due_events(Time now);
  bool handle_ahead(Time end, Time& next_event);
  bool watched() const;
  void settle(Time until);

  struct Scheduled {
    Time at;
    std::function<void()> deed;
  };

  Dispatcher events_;
  Parts<SharedLine> lines_;
  Parts<Plc> plcs_;
  Parts<RequesterStation> requesters_;
  Parts<HostStation> host_ports_;
  Parts<ResponderStation> responders_;
  Parts<PollerStation> pollers_;
  std::vector<Scheduled> schedule_;
  std::size_t done_ = 0;          // number of actions done
  Time next_scheduled_ = kNever;  // when the next one is
  Time doing_at_ = kNever;        // instant of the action that is being done
  std::function<void(std::size_t number, bool done)> watcher_{};
  Time clock_ = 0;        // while no CPU has power
  bool in_step_ = false;  // the way of running, which is not state
  StopToken stop_request_{};
};

}  // namespace s7200::serial
