// Sees what a station executes, and what all do on its line, while the past is played for `why`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "interpreter/base/stop_token.hpp"
#include "interpreter/trace/trace_reasons.hpp"
#include "tools/session/causes/line/line_account.hpp"
#include "tools/session/past/reader.hpp"

namespace s7200::tools {

class Witness final : public Reader {
 public:
  Witness(History& history, std::size_t station, std::uint8_t port, StopToken stop_request);

  bool before_action() override;
  void acted() override { line.note_action(); }
  void planned_done(std::size_t) override { line.note_planned(); }
  void record(const TraceRecord& record) override;
  void instruction(const InstructionRecord& record) override;

  struct Left {
    Time known = 0;  ///< since when
    Time at = 0;     ///< when nothing is known to have decided it
    TraceReasons::Unanswered frame;
  };
  /// Frames that the program has left, known since then.
  std::vector<Left> left_since(Time since, Time now) const;

  /// A character that came in for the interrupt routine attached to it.
  struct ForInterrupt {
    Time since = 0;  ///< start edge
    Time at = 0;     ///< of the event
    std::uint8_t port = 0;
    bool lost = false;  ///< the queue was full
  };
  std::vector<ForInterrupt> for_interrupts_since(std::uint8_t port, Time since) const;

  /// An interrupt routine that was executed.
  struct Service {
    std::uint8_t routine = 0;
    Time at = 0, end = 0;
  };
  /// Those that have begun since then.
  std::vector<Service> services_since(Time since) const;

  /// An RCV that had no power flow, and the contacts of its rung: `LD SM0.1: SM0.1=0`.
  struct PassedOver {
    Time at = 0;
    std::string contacts{};
  };
  /// The last time that this happened to an RCV; null if it never did.
  const PassedOver* passed_over(std::uint32_t op) const;

  /// An XMT to the port that has caused a run-time error.
  struct Refused {
    Time at = 0;
    std::uint32_t op = 0;
    std::uint16_t code = 0;
  };
  const std::vector<Refused>& refused() const { return refused_; }

  /// The last STOP with power flow, and the contacts of its rung.
  struct StopExecuted {
    std::uint32_t op = 0;
    std::string contacts{};
  };
  const std::optional<StopExecuted>& stop_executed() const { return stop_executed_; }

  /// What a scan was spent with, until now: the instruction that ends a loop, and the interrupt routine, that came most
  /// often.
  struct Most {
    std::uint32_t what = 0;  ///< op, or number of the routine
    std::size_t times = 0;
  };
  Most most_repeated() const { return most_of(repeated_); }
  Most most_served() const { return most_of(served_); }

  TraceReasons reasons;
  LineAccount line;

 private:
  void note_passed_over(const InstructionRecord& record);
  void note_for_interrupts(const TraceRecord& record);
  void note_scan(const TraceRecord& record);
  void note_scan(const InstructionRecord& record);
  static Most most_of(const std::unordered_map<std::uint32_t, std::size_t>& counts);

  const History& history_;
  std::size_t station_;
  std::uint8_t port_;
  bool stopped_ = false;
  std::vector<Left> left_;
  Time character_ = 0;  // start edge of the last one received
  std::vector<ForInterrupt> for_interrupts_;
  std::vector<Service> services_;
  std::unordered_map<std::uint32_t, PassedOver> passed_over_;  // by op
  std::vector<Refused> refused_;
  std::optional<StopExecuted> stop_executed_;
  std::unordered_map<std::uint32_t, std::size_t> repeated_, served_;  // in this scan, by op and by routine
};

}  // namespace s7200::tools
