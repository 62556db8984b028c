#include "serial_sim/line.hpp"

#include <algorithm>
#include <cassert>

namespace s7200::serial {

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
  for (LineListener* listener : listeners_.list) listener->line_changed(at);
}

bool Line::level(Time at) const {
  return std::all_of(drivers_.begin(), drivers_.end(), [at](const Driver& driver) { return driver.level(at); });
}

bool Line::level_of(int driver, Time at) const { return drivers_.at(static_cast<std::size_t>(driver)).level(at); }

bool Line::level_without(int driver, Time at) const {
  for (int other = 0; other < kDrivers; ++other)
    if (other != driver && !level_of(other, at)) return false;
  return true;
}

Time Line::next_edge(Time after) const {
  Time next = kNever;
  for (const Driver& driver : drivers_) {
    const std::size_t index = driver.edges_until(after);
    if (index < driver.edges.size()) next = std::min(next, driver.edges[index]);
  }
  return next;
}

Time Line::falling_edge(Time from) const {
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

/// Until when drivers that were at space already just before `edge` hold it; before `edge` when there are none.
Time Line::space_held_from_before(Time edge) const {
  Time held = edge - 1;
  for (const Driver& driver : drivers_) {
    if (!driver.level(edge - 1)) held = std::max(held, driver.next_edge(edge, true));
  }
  return held;
}

void Line::forget(Time now) {
  for (const LineListener* listener : listeners_.list) now = std::min(now, listener->needs_from());
  for (Driver& driver : drivers_) driver.forget(now);
}

void Line::attach(LineListener& listener) { listeners_.list.push_back(&listener); }

void Line::detach(LineListener& listener) { std::erase(listeners_.list, &listener); }

}  // namespace s7200::serial
