#include "tools/session/observers/last_executions.hpp"

#include <algorithm>
#include <utility>

#include "tools/session/past/reader.hpp"

namespace s7200::tools {
namespace {

/// The last execution of each instruction of [first, end).
class Status final : public Reader {
 public:
  Status(const Cpu& cpu, std::size_t station, std::uint32_t first, std::uint32_t end, StopToken stop_request)
      : Reader(station, stop_request), cpu_(cpu), first_(first), end_(end) {}

  void instruction(const InstructionRecord& record) override {
    if (record.op >= first_ && record.op < end_) part_[record.op] = execution_of(record, cpu_);
  }

  /// The part that was played is over; what was found later stands.
  void end_part() {
    last.merge(part_);
    part_.clear();
  }
  bool complete() const { return last.size() == end_ - first_; }

  std::map<std::uint32_t, Execution> last;

 private:
  const Cpu& cpu_;
  std::uint32_t first_, end_;
  std::map<std::uint32_t, Execution> part_;
};

}  // namespace

LastExecutions last_executions(History& history, std::size_t station, std::uint32_t first, std::uint32_t end, Time within,
                               StopToken stop_request) {
  Status status(history.station(station).cpu(), station, first, end, stop_request);
  const Moment start = history.now();
  const Time oldest = start.time - std::min(start.time, within);
  Time looked_at = start.time;
  const History::Search search = history.search_back(
      status, start, [&] { looked_at = history.now().time; },
      [&] {
        status.end_part();
        return status.complete() || looked_at <= oldest;
      });
  history.go_to(start);
  return {std::move(status.last), looked_at, search == History::Search::Interrupted};
}

}  // namespace s7200::tools
