#include "interpreter/analysis/times/interrupt_waits.hpp"

#include <algorithm>
#include <functional>

namespace s7200 {
namespace {

constexpr Time kLongestBusy = 100 * kSecond;  ///< what is busy for longer has no bound

using Sources = std::vector<InterruptSource>;

/// The time of all that come from 0 to `until`, both included.
Time demand(const Sources& sources, Time until) {
  Time sum = 0;
  for (const InterruptSource& source : sources) sum += (until / source.period + 1) * source.routine;
  return sum;
}

/// A busy period of a queue.
class BusyPeriod {
 public:
  BusyPeriod(const Sources& sources, Queue queue, Time kept_away) : kept_away_(kept_away) {
    std::ranges::copy_if(sources, std::back_inserter(own_), [&](const auto& source) { return source.queue == queue; });
    std::ranges::copy_if(sources, std::back_inserter(first_), [&](const auto& source) { return source.queue < queue; });
    std::ranges::sort(own_, std::greater(), &InterruptSource::routine);
  }

  std::optional<InterruptWait> wait(Time routine) const {
    Sources both = own_;
    both.insert(both.end(), first_.begin(), first_.end());
    if (load_of(both) >= 1) return {};
    InterruptWait wait;
    std::vector<Time> begins;  // of those of the queue that have come, in their order
    Time begin = 0, of_queue = 0;
    for (Time at = 0;; at = next_after(at)) {
      if (at > kLongestBusy) return {};
      begin = begin_of(demand(own_, at) - routine, begin);
      if (begin < at) return wait;
      wait.longest = std::max(wait.longest, begin - at);
      for (const InterruptSource& source : own_) {
        if (at % source.period != 0) continue;
        begins.push_back(begin_of(of_queue, begins.empty() ? 0 : begins.back()));
        of_queue += source.routine;
      }
      const auto waiting = static_cast<std::size_t>(begins.end() - std::ranges::upper_bound(begins, at));
      wait.waiting_in_queue = std::max(wait.waiting_in_queue, waiting);
    }
  }

 private:
  Time next_after(Time at) const {
    Time next = own_.front().period * (at / own_.front().period + 1);
    for (const InterruptSource& source : own_) next = std::min(next, source.period * (at / source.period + 1));
    return next;
  }

  /// When the CPU has served so much of the queue, and all that has come in queues before it. Not before `earliest`.
  Time begin_of(Time of_queue, Time earliest) const {
    for (Time begin = std::max(earliest, kept_away_ + of_queue);;) {
      const Time next = kept_away_ + of_queue + demand(first_, begin);
      if (next <= begin) return begin;
      begin = next;
    }
  }

  Time kept_away_;
  Sources own_{}, first_{};  // of its queue, the longest first; of those served before
};

}  // namespace

double load_of(const std::vector<InterruptSource>& sources) {
  double load = 0;
  for (const InterruptSource& source : sources)
    load += static_cast<double>(source.routine) / static_cast<double>(source.period);
  return load;
}

std::optional<InterruptWait> interrupt_wait(const std::vector<InterruptSource>& sources, Queue queue, Time routine,
                                            Time kept_away) {
  return BusyPeriod(sources, queue, kept_away).wait(routine);
}

}  // namespace s7200
