// The past of a simulation: every moment since its beginning can be reached again.
//
// It may have several PLCs, its stations. While anyone looks at instructions the CPUs run in step (system.hpp), so that
// there is one order of all instructions, in which a moment has its place.
//
// A run is deterministic, so the past is computed anew: from the last checkpoint before the moment, with everything that was
// done to the simulation from outside done again where it was done. Scans that are all alike and are passed over need no
// checkpoint among them: they are passed over again. Checkpoints are thinned when they take more memory than they may; the
// beginning stays, unless what came in over a bridge takes more memory than it may: then the older half of it is forgotten,
// and the past begins at a checkpoint after it. What has run once is a recording: going forward from a past moment plays it
// up to its end, and only then is anything new. Something else done to the simulation in its past begins a new branch.
#pragma once

#include <atomic>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "interpreter/base/stop_token.hpp"
#include "interpreter/trace/trace.hpp"
#include "tools/session/past/actions/action.hpp"
#include "tools/session/past/actions/host_frames.hpp"
#include "tools/session/past/actions/plc_requests.hpp"
#include "tools/session/past/checkpoint.hpp"
#include "tools/session/past/line_stations.hpp"
#include "tools/session/past/moment.hpp"
#include "tools/session/past/written_memory.hpp"

namespace s7200::tools {

struct PowerCycle;

/// All that it takes to run a history again, and where it stands.
struct Recording {
  std::vector<RetentiveMemory> memory;  ///< by station: it begins with power coming back; none: as the simulation was given
  std::vector<Action> actions;
  std::vector<std::size_t> stations;  ///< at which the actions were done; of a HostCall the number of the host port
  std::vector<Moment> moments;        ///< of the actions
  Moment end, now;
  bool complete = true;                       ///< false: its beginning is forgotten, and it cannot be run again
  std::shared_ptr<const PowerCycle> power{};  ///< that it begins after; null if it does not, or if it was loaded
  std::vector<std::string> checkpoints{};     ///< packed, in order: so that any moment is near one of them
};

/// Power that went off and came back.
struct PowerCycle {
  Recording before;  ///< up to its `now`
  bool ram_lost = false;
  Time off = 0;  ///< for how long
};

/// Watches a run: live, or played again.
class Observer : public TraceSink {
 public:
  Observer() = default;
  /// Is told of one station alone.
  explicit Observer(std::size_t station) : only_(station) {}
  bool watches(std::size_t station) const { return !only_ || *only_ == station; }

  /// Something is about to be done to the simulation, now(). False stops before it.
  virtual bool before_action() { return true; }

  /// Something was done to the simulation, which is the same as it was in front of an instruction otherwise.
  virtual void acted() {}

  /// What the system file has planned for this instant is about to be done, and was done; by its number.
  virtual void before_planned(std::size_t /*number*/) {}
  virtual void planned_done(std::size_t /*number*/) {}

  /// How far to run on from `now` while no CPU executes a program, or to play what has run; `now` ends it. It is asked
  /// again on the way.
  virtual Time idles_until(Time /*now*/) { return kNever; }

  /// Without wants_scans(): up to when scans that are all alike may be passed over at once.
  virtual Time passes_over_until() const { return kNever; }

 private:
  std::optional<std::size_t> only_;
};

/// A master that polls, as a station of the system.
struct PollingMaster {
  std::string name;
  const serial::Poller* poller = nullptr;
};

/// What a PLC of a system is known as.
struct NamedPlc {
  std::string name;
  std::optional<std::uint8_t> address{};  ///< of its Modbus slave, if the system file says so
};

class History final {
 public:
  /// Runs the simulation for real: Simulation::run_until(), or the same at the pace of a clock, which tells `meanwhile` now
  /// and then.
  using Drive = std::function<serial::Halt(Time end, const std::function<void()>& meanwhile)>;

  struct Settings {
    Drive drive{};                      ///< none: as fast as the computer can
    std::vector<TraceSink*> records{};  ///< by station, null for none: told what happens for the first time, nothing twice
    std::vector<serial::HostPort*> hosts{};    ///< through which something comes in; none: the one beside the only station
    std::vector<PollingMaster> pollers{};      ///< must live as long as the history
    std::vector<LineStation> line_stations{};  ///< all on the lines of the system
    std::vector<NamedPlc> plcs{};              ///< by station; none: one PLC without a name
    std::vector<std::string> planned{};        ///< what the system file does, in words, in its order
    /// Does a SystemEvent to the rig; none comes without it.
    std::function<void(const EventPlan& event)> carry_out{};
    std::size_t bound = 256 << 20;       ///< bytes for checkpoints
    std::size_t log_bound = 64 << 20;    ///< bytes for what came in over a bridge
    Time interval = 500 * kMillisecond;  ///< of checkpoints while it executes, until they have to be thinned
    StopToken stop_request{};            ///< ends what plays for long: go_to() a time, replay()
    std::function<void()> progress{};    ///< told often while something runs or plays
  };

  /// The past begins now. The simulation must live as long as this.
  History(serial::Simulation& simulation, Settings settings);
  /// The same of a system, seen from each of its PLCs, in their order; all must live as long as this.
  History(std::vector<serial::Simulation*> stations, Settings settings);
  ~History();
  History(const History&) = delete;
  History& operator=(const History&) = delete;

  std::size_t stations() const { return stations_.size(); }
  serial::Simulation& station(std::size_t number) { return *stations_[number]; }
  const serial::Simulation& station(std::size_t number) const { return *stations_[number]; }

  /// Through which something may come in, by their numbers.
  const std::vector<serial::HostPort*>& hosts() const { return settings_.hosts; }

  /// Masters that poll, by their numbers.
  const std::vector<PollingMaster>& pollers() const { return settings_.pollers; }

  /// All on the lines, who has a program to step through and who has none.
  const std::vector<LineStation>& line_stations() const { return settings_.line_stations; }

  /// What a PLC is known as, by its station: `slave2`, or `the PLC` without a name.
  std::string name_of(std::size_t station) const;
  /// Who asks, in a sentence: `the master`, `scada`, `slave2`, `gateway`.
  std::string name_of(const Asker& asker) const;
  /// As what its Modbus slave answers, if that is known.
  std::optional<std::uint8_t> address_of(std::size_t station) const;

  /// What the system file does at its instants, in words: `slave2: power off`.
  const std::vector<std::string>& planned() const { return settings_.planned; }

  /// What the programs ask: as of now, in an observer's record() as of before it.
  const PlcRequests& requests() const { return requests_; }

  /// Whether the last characters of a host port, from the beginning of what it gave to the line at once, are so: a frame
  /// that it has sent. False if it is not known any more.
  bool has_sent(std::size_t host, const std::function<bool(std::span<const std::uint8_t>)>& are) const;

  /// Who has a driver of a line: a PLC, a master in the simulation, one on a bridge; `a peer` of another one.
  std::string name_at(const serial::SharedLine& line, int driver) const;

  /// The name of the bridge at a host port; empty if it has none.
  std::string bridge_of(std::size_t host) const;

  /// The host ports of a line that something outside is attached to.
  std::vector<std::size_t> hosts_on(const serial::Line& line) const;

  /// What a host port has put on the line, or will put there, since then and a little before.
  std::vector<SentByHost> sent_by_host(std::size_t host, Time since) const;

  /// For observers: the station that they are being told of, or in front of whose instruction something is done.
  std::size_t told_of() const { return told_of_; }

  /// The one whose instruction is next, of those that execute a program. None: no one does.
  std::optional<std::size_t> next_station() const;

  Moment now() const;
  const Moment& newest() const;
  bool in_the_past() const { return now() < newest(); }

  /// Runs from now on until the observer stops it: first what has run already, then what is new. Halt::Time if it was to
  /// end while no CPU executed a program.
  serial::Halt run(Observer& observer);

  /// Plays what has run from now on until `end`, or until the observer stops it; returns whether it came to the end. The
  /// observer is not asked about the instruction that stands there.
  bool play(Observer& observer, const Moment& end);

  /// Plays on from now on until `end` with an observer that changes a PLC, beside what is known, which stays. What was done
  /// from outside is done again at its time; the master gives up what it waits for when its next request is due. It stands
  /// anywhere afterwards: return_to() comes back. Returns whether it came to the end.
  bool play_beside(Observer& observer, Time end);

  /// To a moment of this branch.
  void go_to(const Moment& moment);

  /// To the first moment at or after `time` of this branch, or to its newest moment. False after a stop request; it stands
  /// where it stood then.
  bool go_to(Time time);

  /// For observers, in front of an instruction: that moment. Other clocks may be behind until the run stops there.
  Moment in_front() const;

  enum class Search : std::uint8_t { Found, Oldest, Interrupted };

  /// Whether a station may have written there in a part of the past, between two checkpoints.
  using MayHold = std::function<bool(std::size_t part)>;

  /// Plays ever earlier parts of what ran before `end`, each from its beginning to its end and `begin` told before it, until
  /// something was found in one. Parts that cannot hold it are passed over. Interrupted: the observer has stopped it. It
  /// stands anywhere afterwards, at the oldest moment if nothing was found.
  Search search_back(
      Observer& observer, Moment end, const std::function<void()>& begin, const std::function<bool()>& found,
      const MayHold& may_hold = [](std::size_t) { return true; });

  /// For search_back(): where a station may have written to this memory.
  MayHold may_have_written(std::size_t station, const MemoryRange& range) const;

  /// Does something to a station, or on its line, now. In the past a new branch begins; what ran on the old one stays in it.
  /// `told`: what that makes happen at once; null for nobody.
  void act(Action action, std::size_t station = 0, Observer* told = nullptr);

  struct Branch;
  using BranchPtr = std::shared_ptr<Branch>;

  /// Where one may return to, whatever has been done since.
  struct Place {
    BranchPtr branch;
    Moment moment;
  };
  Place here() const { return {branch_, now()}; }
  void return_to(const Place& place);

  /// A new branch that begins as the whole history did, with a state of its own, or with power coming back.
  void restart();
  void begin_with(serial::Simulation::Snapshot state);
  /// After power was off for all stations; `ram_lost`: for too long. The field has the levels that it had, which is the
  /// first action of the new branch.
  void power_cycle(bool ram_lost, Time off);

  Recording recording() const;

  /// Of a station's CPU, when all this began.
  const State& origin(std::size_t station) const { return origin_->state.plcs[station].cpu; }

  /// Whether each host port is here through which something came in.
  bool has_hosts_of(const Recording& recording) const;

  /// A new branch: runs the recording, and stands where it stood. Host ports through which something came in need no bridge:
  /// they are attached as it was. False if it cannot come there, or after a stop request; it stands anywhere then.
  /// has_hosts_of() must hold.
  bool replay(Recording recording);

  /// A new branch that stands at the beginning of a recording of one PLC: all of it is past and can be gone to. It is played
  /// when one goes there, and checkpoints are kept on the way, so that no time is spent on what nobody looks at. Unlike
  /// replay() it does not look whether it comes to the same end. has_hosts_of() must hold. False if one of its checkpoints
  /// is not one of this system: it stands at the beginning, without them, then.
  bool adopt(Recording recording);

  /// `most` checkpoints spread over all that has run, packed, for a recording: what lies between two is quickly computed.
  /// Each stands where packed() can write it down, soon after its place; there may be fewer.
  std::vector<std::string> packed_checkpoints(std::size_t most);

  /// Those that are not forgotten.
  const std::vector<Action>& actions() const;
  /// When each of them was done.
  const std::vector<Moment>& action_moments() const;
  /// By its number, which counts those that are forgotten; null if it is one of them.
  const Action* action(std::size_t number) const;
  /// At which it was done, of one that is not forgotten; of a HostCall the number of the host port.
  std::size_t station_of_action(std::size_t number) const;
  /// When it was done.
  const Moment& moment_of_action(std::size_t number) const;

  struct Usage {
    std::size_t checkpoints = 0;  ///< of this branch
    std::size_t bytes = 0;        ///< of all branches that can be returned to
    Time interval = 0;
    Moment oldest;
    std::size_t forgotten = 0;  ///< actions before it: not null if it is not the beginning
    std::size_t log_bound = 0;  ///< bytes that what came in over a bridge may take
  };
  Usage usage() const;

 private:
  using CheckpointPtr = std::shared_ptr<const Checkpoint>;

  /// What watches a station's CPU.
  class Tap final : public TraceSink {
   public:
    Tap(History& history, std::size_t station) : history_(history), station_(station) {}
    void record(const TraceRecord& record) override { history_.record(station_, record); }
    bool before(std::uint32_t op) override { return history_.before(station_, op); }
    void instruction(const InstructionRecord& record) override { history_.instruction(station_, record); }
    bool wants_instructions() const override { return history_.wants_instructions(station_); }
    bool wants_scans() const override { return history_.wants_scans(station_); }

   private:
    History& history_;
    std::size_t station_;
  };

  /// What writes down the calls of a host port.
  class Journal final : public serial::HostJournal {
   public:
    Journal(History& history, std::size_t host) : history_(history), host_(host) {}
    void host_called(const serial::HostCall& call) override { history_.host_called(host_, call); }

   private:
    History& history_;
    std::size_t host_;
  };

  void record(std::size_t station, const TraceRecord& record);
  bool before(std::size_t station, std::uint32_t op);
  void instruction(std::size_t station, const InstructionRecord& record);
  bool wants_instructions(std::size_t station) const;
  bool wants_scans(std::size_t station) const;
  void host_called(std::size_t host, const serial::HostCall& call);
  void planned(std::size_t number, bool done);
  TraceSink* records_of(std::size_t station) const;

  PlcRequests::Others others();
  serial::System& system() const { return stations_.front()->system(); }
  Time time() const { return system().time(); }
  std::uint64_t executed() const;
  bool executes() const { return next_station().has_value(); }
  bool stopped() const;
  Time latest_clock() const;

  serial::Halt run_live();
  serial::Halt run_live_until(Time end);
  bool passes_over() const;
  serial::Halt run_until(Time end);
  bool advance(const Moment& target);
  bool reach(const Moment& moment);
  bool pass(Time end);
  bool come_to_stop(const Moment& moment);
  serial::Halt drive(Time end);
  const Moment& next_action() const;
  bool has_next_action() const;
  void forget();
  bool do_next_action();
  bool can_be_done_beside(const Action& action, std::size_t station);
  const LineStation* station_of_fault(const Action& action, std::size_t station) const;
  bool play_to(Time time);
  bool explore(Time time);
  Moment passed_over(Moment end, const MayHold& may_hold) const;
  void note_unknown_writes(std::size_t station);
  std::vector<WrittenMemory> nothing_written() const;
  void tell_progress() const {
    if (settings_.progress) settings_.progress();
  }
  bool stop_requested() const { return settings_.stop_request.stop_requested(); }
  Moment go_to_before(const Moment& end, Time ahead);
  void begin_branch(serial::Simulation::Snapshot state);
  void power_up_stations(const std::vector<RetentiveMemory>& memory);
  void attach_hosts_of(const Recording& recording);
  void fork();
  CheckpointPtr checkpoint_of(serial::Simulation::Snapshot state);
  CheckpointPtr counted(Checkpoint checkpoint);
  std::size_t part_of(const Moment& moment) const;
  std::size_t part_of(Time time) const;
  std::size_t part_before(const Moment& moment) const;
  void keep_checkpoint(std::size_t part);
  bool take_checkpoints_of(const Recording& recording);
  bool come_to_quiet(Time until);
  void thin();
  void restore(const Checkpoint& checkpoint);
  bool stands_at(const Moment& moment) const;

  std::vector<serial::Simulation*> stations_;
  Settings settings_;
  std::vector<std::unique_ptr<Tap>> taps_;          // by station
  std::vector<std::unique_ptr<Journal>> journals_;  // by host port
  PlcRequests requests_;
  std::vector<WriteMarker> markers_;    // by station
  bool alone_;                          // one CPU, whose power no system file switches
  std::shared_ptr<std::size_t> bytes_;  ///< of all checkpoints
  CheckpointPtr origin_;
  BranchPtr branch_;
  std::vector<std::weak_ptr<Branch>> branches_;

  // Where it is.
  std::size_t actions_ = 0;
  bool settled_ = false;

  // Of the run under way.
  Observer* observer_ = nullptr;
  bool live_ = false;
  bool beside_ = false;  ///< what it plays is not what has run
  std::size_t told_of_ = 0;
  std::optional<std::uint64_t> goal_;  ///< instructions
  Time checkpoint_due_ = kNever;       ///< in front of the first instruction from then on
  bool stopped_for_checkpoint_ = false;
  bool stopped_by_observer_ = false;
  std::uint32_t looked_ = 0;  ///< instructions, for tell_progress()
};

/// What ran, from the beginning of the history: until `end`, and once or again.
struct History::Branch {
  std::vector<CheckpointPtr> checkpoints;             ///< in order; the first is the beginning
  std::vector<std::vector<WrittenMemory>> written{};  ///< since each of them, by station
  std::vector<Action> actions;
  std::vector<std::size_t> stations;  ///< of the actions
  std::vector<Moment> moments;        ///< of the actions
  std::size_t forgotten = 0;          ///< actions before these
  std::size_t log_bytes = 0;          ///< of the actions
  bool unexplored = false;            ///< it was recorded elsewhere: between its checkpoints there may be others to come
  Moment end;
  Time interval = 0;
  std::vector<RetentiveMemory> memory{};      ///< by station: it begins with power coming back
  std::shared_ptr<const PowerCycle> power{};  ///< after which it begins
};

}  // namespace s7200::tools
