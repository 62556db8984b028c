// Where the simulated time of a run went: by routine, network and instruction, by scan and by interrupt.
//
// Execution times come from the CPU's table of times, so the parts add up to the simulated time to the nanosecond.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "interpreter/analysis/flow/flow.hpp"
#include "interpreter/cpu/cpu.hpp"
#include "interpreter/trace/trace_reasons.hpp"

namespace s7200::tools {

/// How often there was each duration. All in ns of simulated time.
class Durations {
 public:
  void add(Time duration, std::uint64_t times = 1) { counts_[duration] += times; }
  void add(const Durations& other) {
    for (const auto& [duration, times] : other.counts_) add(duration, times);
  }
  bool empty() const { return counts_.empty(); }
  std::uint64_t count() const;
  Time total() const;
  Time least() const { return counts_.empty() ? 0 : counts_.begin()->first; }
  Time most() const { return counts_.empty() ? 0 : counts_.rbegin()->first; }
  Time mean() const;
  /// The shortest duration that at least this share (0 to 1) of all do not exceed; 0 if there is none.
  Time within(double share) const;

  /// Durations from `from` to before `to`.
  struct Bin {
    Time from = 0, to = 0;
    std::uint64_t count = 0;
    bool operator==(const Bin&) const = default;
  };
  /// The bins that are not empty, ascending: of 1, 2 or 5 times a power of ten, so that there are about ten of the same
  /// width if the durations are near each other, and three a decade if they are not.
  std::vector<Bin> histogram() const;

 private:
  std::map<Time, std::uint64_t> counts_;
};

/// The run that something was seen in.
struct ProfileOrigin {
  std::string plc{};       ///< empty in a run of one program
  std::string scenario{};  ///< empty of a run that is none
  std::string debug{};     ///< the command of the shell that opens it in the debugger; empty of a run that is no scenario
};

/// A scan, and where its time went.
struct ProfiledScan {
  std::uint64_t number = 0;  ///< since the CPU went to RUN
  Time begin = 0, length = 0;
  std::vector<Time> routines{};  ///< in ControlFlow::routines: their time in it, with that of interrupts
  std::uint64_t interrupts = 0;
  ProfileOrigin in{};
};

/// The time that an interrupt waited, and why.
struct ProfiledWait {
  Time at = 0, waited = 0;  ///< when it was served
  std::string why{};        ///< what it waited for, in words
  ProfileOrigin in{};
};

/// The services of an event.
struct ProfiledEvent {
  std::uint8_t routine = 0;  ///< that served it last
  Durations service;         ///< from its entry to its return
  Durations latency;         ///< from the event to its entry
  ProfiledWait worst{};
};

struct Profile {
  std::shared_ptr<const Program> program{};
  Time total = 0;   ///< simulated
  Time system = 0;  ///< outside the program: the system's parts of scans, and STOP
  /// The routines that are open, the outermost first, in ControlFlow::routines.
  using Stack = std::vector<std::uint32_t>;
  struct OfStack {
    std::vector<Time> ops;  ///< of the program: time in them while these routines were open
    Time entry = 0;         ///< of an interrupt routine: the CPU's time to enter it
  };
  std::map<Stack, OfStack> stacks{};
  std::vector<std::uint64_t> executed{};  ///< by op
  Durations scans{};
  std::map<std::uint32_t, Durations> networks{};  ///< by the first op: their time in scans in which they took any
  std::optional<ProfiledScan> worst_scan{};
  std::map<std::uint8_t, ProfiledEvent> events{};

  /// Time by op, without that of what it calls.
  std::vector<Time> by_op() const;
  /// The time to enter interrupt routines.
  Time entries() const;
  /// Adds another run of the same program. PLCs that it names itself keep their names.
  void add(const Profile& other, const ProfileOrigin& origin);
};

/// Watches one CPU with this program over any number of power-ups. Every scan is run.
class ProfileSink final : public TraceSink {
 public:
  explicit ProfileSink(std::shared_ptr<const Program> program);

  /// The CPU that is watched from now on, before it is powered up: its clock will stand at 0 or where it is then. It is not
  /// owned.
  void begin(const Cpu& cpu);
  /// What was seen up to the CPU's time.
  Profile profile() const;

  void record(const TraceRecord& record) override;
  void instruction(const InstructionRecord& record) override;
  bool wants_instructions() const override { return true; }
  Watch watch() const override { return Watch::Flow; }

 private:
  struct Executed {
    Time at = 0, end = 0;
    std::uint32_t op = kNoRoutine;
  };

  void account_until(Time at);
  void leave_routine();
  void begin_scan(const TraceRecord& record);
  void begin_service(const TraceRecord& record);
  void follow();
  Profile::OfStack& here();
  void end_scan(Time at);

  std::shared_ptr<const Program> program_;
  ControlFlow flow_;
  TraceReasons reasons_;
  const Cpu* cpu_ = nullptr;
  Profile profile_;
  Executed executed_last_{};  // all that reasons_ need of instructions, when an interrupt is served
  Time last_ = 0;             // up to where time is accounted for
  bool enters_ = false;       // the CPU enters an interrupt routine
  bool stopped_ = true;       // no power yet, or STOP
  std::uint8_t depth_ = 0;
  bool in_interrupt_ = false;
  Profile::Stack stack_, interrupted_;
  Profile::OfStack* here_ = nullptr;  // of stack_; null: not looked up
  Time in_routine_ = 0;               // in this scan in the last of stack_, not yet in scan_
  std::optional<ProfiledScan> scan_;
  std::vector<std::uint32_t> network_of_;          // by op, the first one
  std::vector<Time> in_networks_;                  // by the first op: their time in the scan so far
  std::vector<std::uint32_t> networks_of_scan_{};  // the first ops of those that took any
};

}  // namespace s7200::tools
