#include "serial_sim/line.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

namespace s7200::serial {
namespace {

constexpr Time kEver = std::numeric_limits<Time>::min();

}  // namespace

/// Counting is faster than searching: there are a handful of edges, and no branch to guess.
std::size_t Line::Driver::edges_until(Time at) const {
  std::size_t count = 0;
  for (const Time edge : edges) count += edge <= at ? 1U : 0U;
  return count;
}

Time Line::Driver::next_edge(Time from, bool mark) const {
  std::size_t next = edges_until(from - 1);
  if (level_after(next) == mark) ++next;
  return next < edges.size() ? edges[next] : kNever;
}

void Line::Driver::add(Time at, bool mark) {
  if (mark == level_after(edges.size())) return;
  assert(edges.empty() || edges.back() <= at);
  // Two edges at one instant leave the level as it was: nobody could see them.
  if (!edges.empty() && edges.back() == at) {
    edges.pop_back();
  } else {
    edges.push_back(at);
  }
}

void Line::Driver::forget(Time before) {
  const std::size_t past = edges_until(before - 1);
  if (past == 0) return;
  mark_before = level_after(past);
  edges.erase(edges.begin(), edges.begin() + static_cast<std::ptrdiff_t>(past));
}

void Line::drive(int driver, Time at, bool mark) {
  drivers_.at(static_cast<std::size_t>(driver)).add(at, mark);
  tell(at);
}

void Line::disturb(const Disturbance& disturbance) {
  if (disturbance.from >= disturbance.to) return;
  disturbances_.push_back(disturbance);
  tell(disturbance.from);
}

void Line::heal(Time at) {
  if (disturbances_.empty()) return;
  for (Disturbance& disturbance : disturbances_) disturbance.to = std::min(disturbance.to, at);
  std::erase_if(disturbances_, [](const Disturbance& d) { return d.from >= d.to; });
  tell(at);
}

bool Line::level(Time at) const { return disturbances_.empty() ? driven_level(at) : disturbed_level(driven_level(at), at); }

bool Line::driven_level(Time at) const {
  return std::all_of(drivers_.begin(), drivers_.end(), [at](const Driver& driver) { return driver.level(at); });
}

bool Line::disturbed_level(bool mark, Time at) const {
  bool held = false;
  for (const Disturbance& disturbance : disturbances_) {
    if (!disturbance.lasts_at(at)) continue;
    switch (disturbance.effect) {
      case Disturbance::Effect::Cuts:
        return true;
      case Disturbance::Effect::HoldsSpace:
        held = true;
        break;
      case Disturbance::Effect::Inverts:
        mark = !mark;
        break;
    }
  }
  return mark && !held;
}

bool Line::level_of(int driver, Time at) const { return drivers_.at(static_cast<std::size_t>(driver)).level(at); }

bool Line::level_without(int driver, Time at) const {
  bool mark = true;
  for (int other = 0; other < kDrivers; ++other) mark = mark && (other == driver || level_of(other, at));
  return disturbed_level(mark, at);
}

Time Line::next_change(Time from) const {
  Time change = kNever;
  for (const Driver& driver : drivers_) {
    const std::size_t index = driver.edges_until(from - 1);
    if (index < driver.edges.size()) change = std::min(change, driver.edges[index]);
  }
  for (const Disturbance& disturbance : disturbances_)
    for (const Time end : {disturbance.from, disturbance.to})
      if (end >= from) change = std::min(change, end);
  return change;
}

Time Line::falling_edge(Time from) const {
  return disturbances_.empty() ? driven_falling_edge(from) : disturbed_falling_edge(from);
}

Time Line::driven_falling_edge(Time from) const {
  for (;;) {
    Time edge = kNever;
    for (const Driver& driver : drivers_) edge = std::min(edge, driver.next_edge(from, false));
    if (edge == kNever) return kNever;
    const Time held = space_held_from_before(edge);
    if (held < edge) return edge;
    if (held == kNever) return kNever;
    from = held + 1;
  }
}

/// Whatever changes the level is looked at in the order of time.
Time Line::disturbed_falling_edge(Time from) const {
  for (;;) {
    const Time change = next_change(from);
    if (change == kNever) return kNever;
    if (!level(change) && level(change - 1)) return change;
    from = change + 1;
  }
}

/// Until when drivers that were at space already just before `edge` hold it; before `edge` when there are none.
Time Line::space_held_from_before(Time edge) const {
  Time held = edge - 1;
  for (const Driver& driver : drivers_) {
    if (!driver.level(edge - 1)) held = std::max(held, driver.next_edge(edge, true));
  }
  return held;
}

void Line::forget(Time now) {
  for (const LineListener* listener : wiring_.listeners) now = std::min(now, listener->needs_from());
  for (Driver& driver : drivers_) driver.forget(now);
  if (disturbances_.empty()) return;
  std::erase_if(disturbances_, [now](const Disturbance& d) { return d.to < now; });
  for (Disturbance& disturbance : disturbances_)
    if (disturbance.from < now) disturbance.from = kEver;  // as the edges before `now`, its begin is past
}

void Line::attach(LineListener& listener) { wiring_.listeners.push_back(&listener); }

void Line::detach(LineListener& listener) { std::erase(wiring_.listeners, &listener); }

void Line::tell(Time at) const {
  for (LineListener* listener : wiring_.listeners) listener->line_changed(at);
}

}  // namespace s7200::serial
