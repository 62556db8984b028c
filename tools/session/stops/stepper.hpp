// Runs a simulation until there is something to look at, forwards or backwards. It only watches: what happens is what
// happens without it.
//
// Every stop but the change to STOP is in front of an instruction. What lies between two instructions (interrupts being
// taken, the system's part of the scan) is over by then. Backwards it stops where a run forwards would have stopped last.
//
// Of several stations it looks at one: steps and goals are of that one. A stop is of the station that it is about, and is in
// front of an instruction of that one; if it executes none any more, in front of the next one of any other.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <vector>

#include "interpreter/base/stop_token.hpp"
#include "interpreter/model/ports.hpp"
#include "tools/session/past/history.hpp"
#include "tools/session/stops/heard_frames.hpp"
#include "tools/session/stops/open_requests.hpp"
#include "tools/session/stops/stop_point.hpp"

namespace s7200::tools {

enum class StopReason : std::uint8_t { Goal, StopPoint, Answer, Limit, Request, CpuStopped, Oldest };

struct Stop {
  StopReason reason{};
  std::size_t station = 0;              ///< that stopped it; the one looked at if none did
  std::vector<Hit> hits{};              ///< whatever the reason
  std::vector<std::size_t> answered{};  ///< Answer: the stations at whose masters of `send` an exchange is over
};

class Stepper final : public Observer {
 public:
  struct Progress {
    std::uint64_t executed = 0;  ///< instructions in this run
    bool left = false;           ///< the instruction it started at has been executed, or the run did not start at one
  };
  /// Asked in front of each instruction: true stops there. An empty one never does.
  using Goal = std::function<bool(const State& state, std::uint32_t op, const Progress& progress)>;

  /// `stop_request` may be set from a signal handler; it may be null. Nothing is owned.
  Stepper(History& history, StopToken stop_request);

  /// Besides the stop request, a run ends as if it had been asked to when this becomes true. Not owned.
  void pause_when(const std::atomic<bool>* asked) { pause_asked_ = asked; }

  /// Which of the stations it looks at, from the next run on; the first one until then.
  void look_at(std::size_t station) { focus_ = station; }
  std::size_t looks_at() const { return focus_; }

  /// Runs until there is something to stop for, or the goal is met. A breakpoint on the instruction that is next does not
  /// count.
  Stop run(const Goal& goal, Time limit, bool stop_at_answer);

  /// Goes back to where the goal was last met, or to the `count`th time before now; or to the last stop, if that is later.
  /// To the oldest moment if there is nothing of the kind; nowhere after a stop request.
  Stop run_back(const Goal& goal, std::uint64_t count, bool stop_at_answer);

  /// The same of the first time before now, whatever there is to stop for on the way.
  Stop run_back_past_stops(const Goal& goal);

  /// In the order in which they were set.
  const std::vector<SetStop>& stops() const { return stops_; }
  /// One more, whose hits count from where it stands.
  void add(StopPoint stop);
  /// Those with a number, of which a system may have several; false if there are none.
  bool remove(int number);
  void remove_all() { stops_.clear(); }

  /// Counts the hits of all stops up to where it stands: someone may have gone there.
  void count_hits();

  /// From when on hits count on the branch where it stands.
  Time counts_since(const SetStop& stop) const;

  /// How long a master on a bridge and a program wait for an answer.
  Time host_timeout() const { return requests_.host_timeout(); }
  void set_host_timeout(Time timeout) { requests_.set_host_timeout(timeout); }

  // Told while running forwards; all must be set.
  std::function<void(std::size_t station, const TraceRecord&)> on_record;
  std::function<void(std::size_t station, const InstructionRecord&, bool started_at)> on_instruction;
  std::function<void(std::size_t station, const serial::Exchange&)> on_answer;
  std::function<void(const StopPoint&, const Hit&)> on_message;  ///< instead of stopping
  /// What the only PLC sends though nothing has come to it, or after the master has given its request up; not with a bridge.
  std::function<void(const SentByPlc&)> on_unasked;

  std::function<void(Time from)> on_search;  ///< told while running backwards: an ever earlier part is being played

  void record(const TraceRecord& record) override;
  bool before(std::uint32_t op) override;
  void instruction(const InstructionRecord& record) override;
  bool wants_instructions() const override { return true; }
  /// Scans that are all alike are passed over while nothing in them can be a reason to stop.
  bool wants_scans() const override;
  Time passes_over_until() const override { return limit_; }
  bool before_action() override;
  void acted() override;
  void planned_done(std::size_t number) override;
  Time idles_until(Time now) override;

 private:
  /// Where a run forwards would have stopped.
  struct Found {
    Moment moment;
    std::optional<Stop> stop;    ///< nothing: the goal
    bool before_action = false;  ///< in front of an instruction in front of which something was done then
    std::size_t skipped = 0;     ///< stops in the part before it
  };

  /// An instruction that is to come, until it has come.
  struct Instruction {
    std::size_t station = 0;
    std::uint32_t op = 0;
    bool in_interrupt = false;
    bool operator==(const Instruction&) const = default;
  };
  /// An instruction in front of which something was done: its stops were looked for before that.
  struct Looked {
    std::uint64_t executed = 0;  ///< instructions before it
    Instruction at{};
  };
  using Places = std::vector<std::optional<Moment>>;

  /// Backwards: the past is played in parts, ever earlier ones.
  struct Search {
    Moment start{};                      ///< where it stood
    std::uint64_t count = 1;             ///< how often the goal is still to be met
    Places first{};                      ///< by station: its first place in the part being played
    Places after{};                      ///< by station: its first place after that part
    std::vector<Found> found{};          ///< in that part
    std::vector<std::size_t> skipped{};  ///< the same: stops that had no power flow, in order
    Time until = 0;                      ///< what comes up at the end of that part is known by then
    std::optional<Found> there{};        ///< where to go
  };

  serial::Simulation& station(std::size_t number) { return history_.station(number); }
  const serial::Simulation& station(std::size_t number) const { return history_.station(number); }
  bool is_turn_of(std::size_t station) const;
  void begin_watching();
  void note_set_since();
  void look_at_conditions();
  void read_values();
  Instruction instruction_of(std::size_t station, std::uint32_t op) const;
  bool stops_before_action();
  std::optional<Looked> looked_before() const;
  bool has_looked_at(const Instruction& instruction) const;
  bool note_place(const Instruction& instruction);
  Found take_found(StopReason reason);
  StopReason stop_with_answer();
  bool has_due_hit();
  void end_idle();
  std::optional<StopReason> reason_to_stop(std::uint32_t op, bool looks_for_places);
  std::optional<StopReason> reason_to_stop_here();
  void note_found_here();
  void begin_search(const Goal& goal, std::uint64_t count, bool stop_at_answer);
  void begin_part();
  bool end_part();
  Stop arrive(History::Search result, const Moment& start);
  std::optional<Found> found_after_part();
  Moment place_of_first_hit(const Moment& earliest);
  bool holds(StopPoint& stop);
  bool has_come_to_hold(StopPoint& stop);
  void hit_places(std::uint32_t op);
  void hit(SetStop& stop, Hit with);
  Time time_of(const Hit& hit) const;
  std::uint64_t count(SetStop& stop, Time at);
  void note_skipped(SetStop& stop);
  void note_accesses(std::uint32_t op);
  void note_record(const TraceRecord& record);
  std::vector<std::uint8_t> note_sent(std::size_t station, const TraceRecord& record);
  void note_frame(HeardFrames::Frame frame);
  bool is_unasked(std::size_t station) const;
  static bool is_meant(const StopPoint& stop, const TraceRecord& record);
  bool answer_complete();
  void note_changes(std::size_t station, const InstructionRecord* by);
  void note_changes_from_outside();
  void look_at_lines(std::size_t station, Time now);
  void note_ended(const EndedRequest& request);
  bool hears(const StopPoint& stop, std::size_t line) const;
  bool asked_to_stop() const { return (stop_request_.stop_requested()) || (pause_asked_ && *pause_asked_); }

  History& history_;
  StopToken stop_request_;
  const std::atomic<bool>* pause_asked_ = nullptr;
  std::size_t focus_ = 0;
  std::vector<SetStop> stops_;

  // Of the run under way.
  Goal goal_;
  Time limit_ = 0;
  bool stop_at_answer_ = false;
  std::optional<Instruction> start_;        ///< of the station it looks at, where it started or the first one after power-up
  std::optional<Instruction> next_;         ///< of any station, that the run started in front of
  std::optional<Looked> looked_;            ///< the last one
  std::optional<std::size_t> cpu_stopped_;  ///< one of several, in this run
  bool executing_start_ = false;            ///< the instruction being executed is the one it started at
  bool backwards_ = false;
  std::vector<std::size_t> accessed_;  ///< stops on memory that the instruction being executed reads or writes
  HeardFrames frames_;
  OpenRequests requests_;
  History::BranchPtr counted_on_;      ///< the branch on which hits were counted last
  std::optional<Moment> listened_to_;  ///< where the last run ended: one from there goes on listening
  std::optional<Moment> held_at_{};    // when the conditions of stops were looked at
  Time executing_since_ = kNever;      ///< the start of the instruction being executed; kNever: none is
  Search search_;                      ///< backwards
  Progress progress_;
  Stop stop_;
};

}  // namespace s7200::tools
