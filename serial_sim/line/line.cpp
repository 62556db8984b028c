#include "serial_sim/line/line.hpp"

#include <algorithm>
#include <cassert>

namespace s7200::serial {
/// Counting is faster than searching: there are a handful of edges, and no branch to guess.
std::size_t Line::Driver::edges_until(Time at) const {
  std::size_t count = 0;
  for (const Time edge : edges) count += edge <= at ? 1U : 0U;
  return count;
}

unsigned Line::Driver::levels(std::span<const Time> at) const {
  if (edges.empty()) return mark_before ? ~0U : 0U;
  unsigned levels = 0;
  bool mark = mark_before;
  auto edge = edges.begin();
  for (std::size_t i = 0; i < at.size(); ++i) {
    for (; edge != edges.end() && *edge <= at[i]; ++edge) mark = !mark;
    levels |= static_cast<unsigned>(mark) << i;
  }
  return levels;
}

Time Line::Driver::next_edge(Time from, bool mark) const {
  std::size_t next = edges_until(from - 1);
  if (level_after(next) == mark) ++next;
  return next < edges.size() ? edges[next] : kNever;
}

void Line::Driver::add(Time at, bool mark) {
  if (mark == level_after(edges.size())) return;
  assert(edges.empty() || edges.back() <= at);
  // Two edges at one instant leave the level as it was: no receiver could see them.
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

bool Line::Drivers::operator==(const Drivers& other) const {
  const std::vector<Driver>& fewer = all.size() < other.all.size() ? all : other.all;
  const std::vector<Driver>& more = &fewer == &all ? other.all : all;
  const auto common = more.begin() + static_cast<std::ptrdiff_t>(fewer.size());
  return std::equal(more.begin(), common, fewer.begin()) &&
         std::all_of(common, more.end(), [](const Driver& driver) { return driver == Driver{}; });
}

bool Line::Periods::lasts_after(std::vector<Time>::const_iterator change) const {
  return lasts_before != ((change - changes.begin()) % 2 != 0);
}

bool Line::Periods::lasts(Time at) const { return lasts_after(std::upper_bound(changes.begin(), changes.end(), at)); }

Time Line::Periods::next_change(Time from) const {
  const auto change = std::lower_bound(changes.begin(), changes.end(), from);
  return change == changes.end() ? kNever : *change;
}

/// Lasts from `from` to `to` too.
void Line::Periods::unite(Time from, Time to) {
  const auto first = std::lower_bound(changes.begin(), changes.end(), from);
  const auto last = to == kNever ? changes.end() : std::upper_bound(first, changes.end(), to);
  const bool begins = !lasts_after(first), ends = to != kNever && !lasts_after(last);
  auto place = changes.erase(first, last);
  if (ends) place = changes.insert(place, to);
  if (begins) changes.insert(place, from);
}

/// Between the two it lasts where it did not, and the other way round.
void Line::Periods::invert(Time from, Time to) {
  toggle(from);
  if (to != kNever) toggle(to);
}

void Line::Periods::toggle(Time at) {
  const auto place = std::lower_bound(changes.begin(), changes.end(), at);
  if (place != changes.end() && *place == at) {
    changes.erase(place);
  } else {
    changes.insert(place, at);
  }
}

void Line::Periods::end(Time at) {
  const auto place = std::lower_bound(changes.begin(), changes.end(), at);
  const bool lasted = lasts_after(place);
  changes.erase(place, changes.end());
  if (lasted) changes.push_back(at);
}

void Line::Periods::forget(Time before) {
  const auto present = std::lower_bound(changes.begin(), changes.end(), before);
  lasts_before = lasts_after(present);
  changes.erase(changes.begin(), present);
}

Line::Driver& Line::driver(int number) {
  assert(number >= 0 && number < kDrivers);
  const auto place = static_cast<std::size_t>(number);
  if (place >= drivers_.all.size()) drivers_.all.resize(place + 1);
  return drivers_.all[place];
}

void Line::drive(int number, Time at, bool mark) {
  driver(number).add(at, mark);
  tell(at);
}

void Line::drive(int number, std::span<const Time> changes) {
  Driver& own = driver(number);
  for (const Time at : changes) own.add(at, !own.level_after(own.edges.size()));
  if (!changes.empty()) tell(changes.front());
}

void Line::disturb(const Disturbance& disturbance) {
  if (disturbance.from >= disturbance.to) return;
  Periods& those = periods(disturbance.effect);
  if (disturbance.effect == Disturbance::Effect::Inverts) {
    those.invert(disturbance.from, disturbance.to);
  } else {
    those.unite(disturbance.from, disturbance.to);
  }
  note_whether_disturbed();
  tell(disturbance.from);
}

void Line::heal(Time at) {
  if (!disturbed_) return;
  for (Periods& those : disturbances_) those.end(at);
  note_whether_disturbed();
  tell(at);
}

void Line::note_whether_disturbed() {
  disturbed_ = !std::all_of(disturbances_.begin(), disturbances_.end(), [](const Periods& those) { return those.none(); });
}

bool Line::level(Time at) const { return disturbed_ ? disturbed_level(driven_level(at), at) : driven_level(at); }

unsigned Line::levels(std::span<const Time> at) const {
  unsigned levels = ~0U;
  if (!disturbed_) {
    for (const Driver& driver : drivers_.all) levels &= driver.levels(at);
  } else {
    for (std::size_t i = 0; i < at.size(); ++i)
      if (!level(at[i])) levels &= ~(1U << i);
  }
  return levels;
}

bool Line::driven_level(Time at) const {
  return std::all_of(drivers_.all.begin(), drivers_.all.end(), [at](const Driver& driver) { return driver.level(at); });
}

bool Line::disturbed_level(bool mark, Time at) const {
  using Effect = Disturbance::Effect;
  if (periods(Effect::Cuts).lasts(at)) return true;
  return mark != periods(Effect::Inverts).lasts(at) && !periods(Effect::HoldsSpace).lasts(at);
}

bool Line::level_of(int driver, Time at) const {
  const auto number = static_cast<std::size_t>(driver);
  return number >= drivers_.all.size() || drivers_.all[number].level(at);
}

bool Line::level_without(int driver, Time at) const {
  bool mark = true;
  for (std::size_t other = 0; other < drivers_.all.size(); ++other)
    mark = mark && (static_cast<int>(other) == driver || drivers_.all[other].level(at));
  return disturbed_level(mark, at);
}

Time Line::next_change(Time from) const {
  Time change = kNever;
  for (const Driver& driver : drivers_.all) {
    const std::size_t index = driver.edges_until(from - 1);
    if (index < driver.edges.size()) change = std::min(change, driver.edges[index]);
  }
  for (const Periods& those : disturbances_) change = std::min(change, those.next_change(from));
  return change;
}

Time Line::falling_edge(Time from) const { return disturbed_ ? disturbed_falling_edge(from) : driven_falling_edge(from); }

Time Line::driven_falling_edge(Time from) const {
  for (;;) {
    Time edge = kNever;
    for (const Driver& driver : drivers_.all) edge = std::min(edge, driver.next_edge(from, false));
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
  for (const Driver& driver : drivers_.all) {
    if (!driver.level(edge - 1)) held = std::max(held, driver.next_edge(edge, true));
  }
  return held;
}

void Line::forget(Time now) {
  for (const LineListener* listener : wiring_.listeners) now = std::min(now, listener->needs_from());
  for (Driver& driver : drivers_.all) driver.forget(now);
  if (!disturbed_) return;
  for (Periods& those : disturbances_) those.forget(now);
  note_whether_disturbed();
}

void Line::attach(LineListener& listener) { wiring_.listeners.push_back(&listener); }

void Line::detach(LineListener& listener) { std::erase(wiring_.listeners, &listener); }

void Line::tell(Time at) const {
  for (LineListener* listener : wiring_.listeners) listener->line_changed(at);
}

}  // namespace s7200::serial
