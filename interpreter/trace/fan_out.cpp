#include "interpreter/trace/fan_out.hpp"

#include <algorithm>

namespace s7200 {

void FanOut::add(TraceSink* sink) {
  if (sink) sinks_.push_back(sink);
}

void FanOut::remove(TraceSink* sink) { std::erase(sinks_, sink); }

void FanOut::record(const TraceRecord& record) {
  for (TraceSink* sink : sinks_) sink->record(record);
}

bool FanOut::before(std::uint32_t op) {
  bool go_on = true;
  for (TraceSink* sink : sinks_)
    if (sink->wants_instructions()) go_on &= sink->before(op);
  return go_on;
}

void FanOut::instruction(const InstructionRecord& record) {
  for (TraceSink* sink : sinks_)
    if (sink->wants_instructions()) sink->instruction(record);
}

bool FanOut::wants_instructions() const {
  return std::any_of(sinks_.begin(), sinks_.end(), [](const TraceSink* sink) { return sink->wants_instructions(); });
}

Watch FanOut::watch() const {
  Watch closest = Watch::Flow;
  for (const TraceSink* sink : sinks_)
    if (sink->wants_instructions()) closest = std::max(closest, sink->watch());
  return closest;
}

TraceSink& FanOut::watcher() {
  const auto wants = [](const TraceSink* sink) { return sink->wants_instructions(); };
  if (std::ranges::count_if(sinks_, wants) != 1) return *this;
  return (*std::ranges::find_if(sinks_, wants))->watcher();
}

bool FanOut::wants_scans() const {
  return std::any_of(sinks_.begin(), sinks_.end(), [](const TraceSink* sink) { return sink->wants_scans(); });
}

}  // namespace s7200
