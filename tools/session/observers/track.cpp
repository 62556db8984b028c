#include "tools/session/observers/track.hpp"

#include <algorithm>
#include <utility>

namespace s7200::tools {
namespace {

void join(TrackSpan& first, TrackSpan&& next) {
  if (first.error.empty()) first.error = std::move(next.error);
  if (next.value) first.value = next.value;
  first.least = std::min(first.least, next.least);
  first.most = std::max(first.most, next.most);
  first.end = std::max(first.end, next.end);
  first.count += next.count;
  first.busy += next.busy;
  first.errors += next.errors;
}

}  // namespace

Track::Track(Time from, Time to, std::size_t most)
    : from_(from), most_(most), part_((to - from + static_cast<Time>(most) - 1) / static_cast<Time>(most)) {}

void Track::add(TrackSpan span) {
  span.busy = span.end - span.at;
  span.errors = span.error.empty() ? 0 : 1;
  span.least = span.most = span.value.value_or(0);
  put(std::move(span));
}

void Track::put(TrackSpan span) {
  if (exact_ && spans_.size() == most_) join_all();
  if (!exact_ && !spans_.empty() && (spans_.back().at - from_) / part_ == (span.at - from_) / part_)
    join(spans_.back(), std::move(span));
  else
    spans_.push_back(std::move(span));
}

void Track::join_all() {
  exact_ = false;
  for (TrackSpan& span : std::exchange(spans_, {})) put(std::move(span));
}

}  // namespace s7200::tools
