// Runs a simulation until there is something to look at, forwards or backwards. It only watches: what happens is what
// happens without it.
//
// Every stop but the change to STOP is in front of an instruction. What lies between two instructions (interrupts being
// taken, the system's part of the scan) is over by then. Backwards it stops where a run forwards would have stopped last.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <vector>

#include "tools/debugger/history.hpp"
#include "tools/debugger/stop_point.hpp"

namespace s7200::tools {

enum class StopReason : std::uint8_t { Goal, StopPoint, Answer, Limit, Request, CpuStopped, Oldest };

struct Stop {
  StopReason reason{};
  std::vector<Hit> hits{};  ///< whatever the reason
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
  Stepper(serial::Simulation& simulation, History& history, const std::atomic<bool>* stop_request);

  /// Runs a CPU that is in RUN. A breakpoint on the instruction it stands at does not count.
  Stop run(const Goal& goal, Time limit, bool stop_at_answer);

  /// Goes back to where the goal was last met, or to the `count`th time before now; or to the last stop, if that is later.
  /// To the oldest moment if there is nothing of the kind; nowhere after a stop request.
  Stop run_back(const Goal& goal, std::uint64_t count, bool stop_at_answer);

  /// Counts the hits of all stops up to where it stands: someone may have gone there.
  void count_hits();

  std::vector<StopPoint> stops;

  /// How long a master on a bridge waits for an answer: its own time-out is not known here. One that sends again before has
  /// given up then.
  Time host_timeout = kSecond;

  // Told while running forwards; all must be set.
  std::function<void(const TraceRecord&)> on_record;
  std::function<void(const InstructionRecord&, bool started_at)> on_instruction;
  std::function<void(const serial::Exchange&)> on_answer;
  std::function<void(const StopPoint&)> on_message;  ///< instead of stopping

  std::function<void(Time from)> on_search;  ///< told while running backwards: an ever earlier part is being played

  void record(const TraceRecord& record) override;
  bool before(std::uint32_t op) override;
  void instruction(const InstructionRecord& record) override;
  bool wants_instructions() const override { return true; }
  /// Scans that are all alike are passed over while nothing in them can be a reason to stop.
  bool wants_scans() const override;
  void acted() override;

 private:
  /// Where a run forwards would have stopped.
  struct Found {
    Moment moment;
    std::optional<Stop> stop;  ///< nothing: the goal
  };

  void begin_watching();
  void read_values();
  bool note_place(std::uint32_t op);
  std::optional<StopReason> reason_to_stop(std::uint32_t op, bool at_start);
  void hit_places(std::uint32_t op);
  void hit(StopPoint& stop, Hit with);
  std::uint64_t count(StopPoint& stop);
  void note_accesses(std::uint32_t op);
  void note_record(const TraceRecord& record);
  void listen_from_now_on();
  void note_silence();
  static bool is_meant(const StopPoint& stop, const TraceRecord& record);
  std::optional<StopReason> reason_between();
  bool answer_complete();
  void note_changes(const InstructionRecord* by);
  void note_unanswered(const std::vector<std::uint8_t>& frame);
  void note_host_request(std::vector<std::uint8_t> frame, Time end);
  void note_host_timeout();
  bool asked_to_stop() const { return stop_request_ && *stop_request_; }

  serial::Simulation& simulation_;
  History& history_;
  const std::atomic<bool>* stop_request_;

  // Of the run under way.
  Goal goal_;
  Time limit_ = 0;
  bool stop_at_answer_ = false;
  bool awaiting_answer_ = false;
  bool standing_ = false;       ///< it started in front of an instruction
  bool reached_start_ = false;  ///< that, or the first one after power-up, has come
  std::uint32_t start_op_ = 0;
  bool started_in_interrupt_ = false;
  bool executing_start_ = false;  ///< the instruction being executed is the one it started at
  bool backwards_ = false;
  std::vector<std::size_t> accessed_;     ///< stops on memory that the instruction being executed reads or writes
  std::vector<std::uint8_t> coming_in_;   ///< characters since the last silence
  Time silence_noted_ = 0;                ///< after the character that ended then; 0: after none
  bool came_in_ = false;                  ///< the last character on the line was received
  std::optional<Time> host_waits_;        ///< a master on a bridge, since the end of its frame
  std::vector<std::uint8_t> host_frame_;  ///< that one; nothing if it is not known
  History::BranchPtr counted_on_;         ///< the branch on which hits were counted last
  std::optional<Moment> listened_to_;     ///< where the last run ended: one from there goes on listening
  std::optional<Moment> first_place_;     ///< backwards: of the part being played
  std::vector<Found> found_;              ///< backwards: in the part being played
  Progress progress_;
  Stop stop_;
};

}  // namespace s7200::tools
