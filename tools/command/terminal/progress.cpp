#include "tools/command/terminal/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/host/console.hpp"
#include "tools/host/host_time.hpp"
#include "tools/host/interruption.hpp"

namespace s7200::tools {
namespace {

/// From what part of its limit on the size of a record is estimated.
constexpr std::uint64_t kEstimatedFrom = 100;

}  // namespace

Progress::Progress(std::function<Time()> now, std::function<std::vector<RecordSize>()> records, const RunLimits& limits)
    : now_(std::move(now)), records_(std::move(records)), limits_(limits), next_(host_time() + 2 * kSecond) {}

/// A run without a known end has no size there.
double Progress::at_end(const RecordSize& record) const {
  const auto size = static_cast<double>(record.bytes);
  if (limits_.end == kNever || now_() <= 0) return size;
  return size * static_cast<double>(limits_.end) / static_cast<double>(now_());
}

void Progress::note_too_large(const std::vector<RecordSize>& records) {
  for (const RecordSize& record : records) {
    if (noted_ || record.bytes < record.limit / kEstimatedFrom || at_end(record) <= static_cast<double>(record.limit))
      continue;
    noted_ = true;
    print_note(
        fmt::format("{} would have about {} at the end, and the run ends when it has {}; --record-limit says otherwise",
                    stl::printable(record.path), size_text(at_end(record)), size_text(static_cast<double>(record.limit))));
  }
}

bool Progress::operator()() {
  const std::vector<RecordSize> records = records_();
  note_too_large(records);
  const Time now = host_time();
  const bool goes_on = std::ranges::none_of(records, &RecordSize::full);
  if (now <= next_ || !is_terminal(Standard::Error)) return goes_on;
  next_ = now + kSecond;
  const std::string goal = limits_.end == kNever ? counted(limits_.scans, "scan") : format_duration(limits_.end);
  fmt::print(stderr, "\r{} of {} simulated", format_duration(now_()), goal);
  for (const RecordSize& record : records)
    fmt::print(stderr, ", {} {} of about {}", stl::printable(record.path), size_text(static_cast<double>(record.bytes)),
               size_text(at_end(record)));
  if (now_() >= limits_.end) fmt::print(stderr, "\n");
  return goes_on;
}

CountedProgress::CountedProgress(std::string what) : what_(std::move(what)), next_(host_time() + 2 * kSecond) {}

void CountedProgress::operator()(std::uint64_t count) {
  const Time now = host_time();
  if (now <= next_ || !is_terminal(Standard::Error)) return;
  next_ = now + kSecond;
  shown_ = true;
  fmt::print(stderr, "\r{}", counted(count, what_));
}

void CountedProgress::end() {
  if (std::exchange(shown_, false)) fmt::print(stderr, "\n");
}

Waiter waiting_with(CountedProgress& progress) {
  return {interruption(), [&progress, steps = std::uint64_t{0}]() mutable { progress(++steps); }};
}

std::string ending_text(std::string_view reason) {
  return reason == "interrupted" ? std::string(reason) : fmt::format("ended by {}", reason);
}

}  // namespace s7200::tools
