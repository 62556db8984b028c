#include "tools/session/commands/answers/live_trace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "interpreter/trace/text/text_trace.hpp"
#include "tools/session/commands/session.hpp"
#include "tools/session/observers/trace_of_past.hpp"

namespace s7200::tools {
namespace {

/// By then whatever belongs to an instant has been told.
constexpr Time kTold = kSecond;

constexpr std::size_t kMostWaiting = 10'000;

}  // namespace

void LiveTrace::turn(bool on) {
  on_ = on;
  follows_ = false;
  follow();
  for (TraceLines& lines : lines_) lines.begin_way();
}

void LiveTrace::follow() {
  if (!on_ || std::exchange(follows_, true)) return;
  std::vector<TraceLines*> traces;
  for (TraceLines& lines : lines_) traces.push_back(&lines);
  tell_what_was_before(session_.history, traces, session_.setup.stop_request);
}

void LiveTrace::note(std::size_t station, const TraceRecord& record) {
  if (!on_) return;
  const std::vector<TraceLine> lines = lines_[station].of(record);
  if (record.kind != TraceKind::ScanBegin && is_shown(record)) tell(station, lines);
}

void LiveTrace::note(std::size_t station, const InstructionRecord& record) {
  if (const auto line = on_ ? lines_[station].of(record) : std::nullopt) tell(station, {*line});
}

/// CPUs of a system end their instructions at different times, and the way of a program is told at its end: lines wait until
/// no other one can come before them.
void LiveTrace::tell(std::size_t station, const std::vector<TraceLine>& lines) {
  if (!session_.is_system()) {
    for (const TraceLine& line : lines) tell_line(line);
    return;
  }
  const std::size_t width = session_.name_width();
  for (const TraceLine& line : lines)
    waiting_.push_back({line.at, fmt::format("{:<{}}  {}", session_.name_of(station), width, line.text), line.trouble});
  const Time now = session_.history.now().time;
  if (waiting_.size() >= kMostWaiting) write(now - std::min(now, kTold));
}

void LiveTrace::tell_line(const TraceLine& line) {
  const std::string text = fmt::format("  {}  {}", clock_text(line.at), line.text);
  session_.tell((line.trouble ? session_.onlooker.emphasized(text, Emphasis::Warning) : text) + "\n");
}

void LiveTrace::write(Time until) {
  std::ranges::stable_sort(waiting_, {}, &TraceLine::at);
  const auto rest = std::ranges::lower_bound(waiting_, until, {}, &TraceLine::at);
  for (auto line = waiting_.begin(); line != rest; ++line) tell_line(*line);
  waiting_.erase(waiting_.begin(), rest);
}

}  // namespace s7200::tools
