#include "tools/session/observers/timeline_of_past.hpp"

#include <algorithm>

#include "tools/session/observers/trace_of_past.hpp"
#include "tools/session/past/reader.hpp"

namespace s7200::tools {
namespace {

class TimelineReader final : public Reader {
 public:
  TimelineReader(std::size_t station, const std::shared_ptr<const Program>& program,
                 const TraceReasons::Disabled& interrupts, StopToken stop_request)
      : Reader(station, stop_request), timeline_(program, nullptr, Timeline::Looks::AtInstructions) {
    timeline_.begin_amid(interrupts);
  }

  void record(const TraceRecord& record) override { timeline_.record(record); }
  void instruction(const InstructionRecord& record) override { timeline_.instruction(record); }

  TimelineReport report() {
    timeline_.end();
    return timeline_.report();
  }

 private:
  Timeline timeline_;
};

}  // namespace

std::optional<TimelineReport> timeline_of_past(History& history, std::size_t station,
                                               const std::shared_ptr<const Program>& program, Time from,
                                               StopToken stop_request) {
  const Moment now = history.now();
  history.go_to(std::min(from, now.time));
  if (now < history.now()) history.go_to(now);
  TimelineReader teller(station, program, interrupts_disabled(history, station, stop_request), stop_request);
  const bool complete = history.play(teller, now);
  history.go_to(now);
  return complete ? std::optional(teller.report()) : std::nullopt;
}

}  // namespace s7200::tools
