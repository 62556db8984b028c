#include "serial_sim/line.hpp"

#include <algorithm>
#include <cassert>

namespace s7200::serial {

void Line::Driver::add(Time at, bool mark) {
  const bool mark_now = edges.empty() ? mark_before : edges.back().mark;
  if (mark == mark_now) return;
  assert(edges.empty() || edges.back().at <= at);
  // Two edges at one instant leave the level as it was: nobody could see them.
  if (!edges.empty() && edges.back().at == at) {
    edges.pop_back();
  } else {
    edges.push_back({at, mark});
  }
}

bool Line::Driver::level(Time at) const {
  const auto later = std::find_if(edges.begin(), edges.end(), [at](const Edge& edge) { return edge.at > at; });
  return later == edges.begin() ? mark_before : std::prev(later)->mark;
}

Time Line::Driver::next_edge(Time from, bool mark) const {
  const auto edge = std::find_if(edges.begin(), edges.end(), [=](const Edge& e) { return e.at >= from && e.mark == mark; });
  return edge == edges.end() ? kNever : edge->at;
}

void Line::Driver::forget(Time before) {
  const auto kept = std::find_if(edges.begin(), edges.end(), [before](const Edge& edge) { return edge.at >= before; });
  if (kept == edges.begin()) return;
  mark_before = std::prev(kept)->mark;
  edges.erase(edges.begin(), kept);
}

void Line::drive(int driver, Time at, bool mark) {
  drivers_.at(static_cast<std::size_t>(driver)).add(at, mark);
  for (LineListener* listener : listeners_.list) listener->line_changed(at);
}

bool Line::level(Time at) const {
  return std::all_of(drivers_.begin(), drivers_.end(), [at](const Driver& driver) { return driver.level(at); });
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
