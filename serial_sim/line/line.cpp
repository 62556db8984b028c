#include "serial_sim/line/line.hpp"

#include <algorithm>
#include <cassert>
#include <iterator>

#include "interpreter/base/split_mix.hpp"

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

void Line::Driver::release(Time at) {
  edges.erase(std::ranges::upper_bound(edges, at), edges.end());
  if (!level_after(edges.size())) add(at, true);
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

/// Adds the period [from, to) to the others.
void Line::Periods::unite(Time from, Time to) {
  const auto first = std::lower_bound(changes.begin(), changes.end(), from);
  const auto last = to == kNever ? changes.end() : std::upper_bound(first, changes.end(), to);
  const bool begins = !lasts_after(first), ends = to != kNever && !lasts_after(last);
  auto place = changes.erase(first, last);
  if (ends) place = changes.insert(place, to);
  if (begins) changes.insert(place, from);
}

/// Inverts [from, to): what lasts there ends, and the other way round.
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

/// The driver with all its edges: an implied character is revealed first.
Line::Driver& Line::driver(int number) const {
  assert(number >= 0 && number < kDrivers);
  reveal();
  const auto place = static_cast<std::size_t>(number);
  if (place >= drivers_.all.size()) drivers_.all.resize(place + 1);
  return drivers_.all[place];
}

void Line::drive(int number, Time at, bool mark) {
  driver(number).add(at, mark);
  changed(number);
  tell(at);
}

void Line::drive(int number, unsigned levels, const BitTimes& times, Time at) {
  const unsigned stop_bit = 1U << times.stop_bit;
  if (may_imply() && (levels & stop_bit) != 0) {
    implied_.driver = number;
    implied_.levels = levels;
    implied_.start = at;
    implied_.last_edge = at + times.begin_of_bit(static_cast<int>(std::bit_width(~levels & (stop_bit - 1))));
    if (!(implied_.times == times)) implied_.times = times;
    changed();
  } else {
    add_edges(number, levels, times, at);
  }
  tell(at);
}

void Line::add_edges(int number, unsigned levels, const BitTimes& times, Time at) const {
  Driver& own = driver(number);
  for (int bit = 0; bit <= times.stop_bit; ++bit) own.add(at + times.begin_of_bit(bit), (levels >> bit & 1U) != 0);
  own.add(at + times.begin_of_bit(times.bits), true);
  changed(number);
}

void Line::reveal_implied() const {
  const int number = implied_.driver;
  implied_.driver = Implied::kNone;
  add_edges(number, implied_.levels, implied_.times, implied_.start);
}

void Line::changed(int number) const {
  const auto place = static_cast<std::size_t>(number);
  const std::uint32_t bit = 1U << place;
  busy_ = drivers_.all[place] == Driver{} ? busy_ & ~bit : busy_ | bit;
  changed();
}

void Line::disturb(const Disturbance& disturbance) {
  if (disturbance.from >= disturbance.to) return;
  reveal();
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
  changed();
  const auto any = [](const Periods& those) { return !those.none(); };
  disturbed_ = std::ranges::any_of(disturbances_, any) || std::ranges::any_of(contention_.marks, any);
}

/// The random level depends only on the seed and the instant, whichever listener asks first.
static bool toss(std::uint64_t seed, Time at) {
  return (split_mix(seed + static_cast<std::uint64_t>(at) * kSplitMixStep) & 1U) != 0;
}

void Line::contend(int number, Time from, Time to) {
  contention_.on_until[static_cast<std::size_t>(number)] = to;
  bool any = false;
  for (int other = 0; other < kDrivers; ++other)
    if (other != number) any |= contend(number, other, from, to);
  if (!any) return;
  note_whether_disturbed();
  tell(from);
}

/// Draws the contended levels anew from `at` on, after a driver has gone off or the cable has been cut or mended.
void Line::contend_anew(Time at) {
  if (contention_.on_until.empty()) return;
  for (Periods& marks : contention_.marks) marks.end(at);
  for (int number = 0; number < kDrivers; ++number)
    for (int other = 0; other < number; ++other)
      contend(number, other, at, contention_.on_until[static_cast<std::size_t>(number)]);
  note_whether_disturbed();
}

/// Space wins where two drivers disagree; where chance says mark instead, receivers find mark. Whether there is such a
/// place.
bool Line::contend(int number, int other, Time from, Time to) {
  bool any = false;
  const Time end = std::min(to, contention_.on_until[static_cast<std::size_t>(other)]);
  for (Time at = from; at < end;) {
    const Time next = std::min({end, next_edge_of(number, at + 1), next_edge_of(other, at + 1), next_separation(at + 1)});
    const std::size_t part = part_of(number, at);
    if (part == part_of(other, at) && level_of(number, at) != level_of(other, at) && toss(contention_.seed, at)) {
      contention_.marks[part].unite(at, next);
      any = true;
    }
    at = next;
  }
  return any;
}

Time Line::next_edge_of(int number, Time from) const {
  const Driver& driver = this->driver(number);
  const std::size_t index = driver.edges_until(from - 1);
  return index < driver.edges.size() ? driver.edges[index] : kNever;
}

void Line::separate(Time at, std::uint32_t far) {
  reveal();
  separations_.push_back({at, far});
  contend_anew(at);
  changed();
  tell(at);
}

void Line::release(int number, Time at) {
  driver(number).release(at);
  changed(number);
  if (!contention_.on_until.empty()) contention_.on_until[static_cast<std::size_t>(number)] = at;
  contend_anew(at);
  tell(at);
}

std::uint32_t Line::far_at(Time at) const {
  std::uint32_t far = 0;
  for (const Separation& separation : separations_)
    if (separation.at <= at) far = separation.far;
  return far;
}

std::optional<Line::Separation> Line::separation(Time at) const {
  const auto after = std::ranges::upper_bound(separations_, at, {}, &Separation::at);
  if (after == separations_.begin() || std::prev(after)->far == 0) return {};
  return *std::prev(after);
}

/// The part of the cable that a driver is on: 0 is the near part or the whole cable, 1 is the far part.
std::size_t Line::part_of(int driver, Time at) const { return driver == kWholeCable ? 0 : far_at(at) >> driver & 1U; }

std::uint32_t Line::audible(int listener, Time at) const {
  if (listener == kWholeCable) return ~0U;
  const std::uint32_t far = far_at(at);
  return (far >> listener & 1U) != 0 ? far : ~far;
}

bool Line::chance_says_mark(Time at, int listener) const { return contention_.marks[part_of(listener, at)].lasts(at); }

Time Line::next_separation(Time from) const {
  const auto next = std::ranges::find_if(separations_, [&](const Separation& each) { return each.at >= from; });
  return next == separations_.end() ? kNever : next->at;
}

bool Line::level(Time at, int listener) const {
  if (implied_.any() && implied_.in_start_bit(at)) return false;
  if (irregular()) return irregular_level(at, listener);
  if (answers_.level_at == at) return answers_.level;
  answers_.level_at = at;
  return answers_.level = driven_level(at);
}

bool Line::irregular_level(Time at, int listener) const {
  return disturbed_level(driven_level(at, audible(listener, at)) || chance_says_mark(at, listener), at);
}

unsigned Line::levels(Time start, const BitTimes& times, int listener) const {
  if (implied_.any() && implied_.start == start && implied_.times == times) return implied_.levels;
  std::array<Time, SerialFormat::kMostBits> middles{};
  for (int bit = 0; bit <= times.stop_bit; ++bit) middles[static_cast<std::size_t>(bit)] = start + times.middle_of_bit(bit);
  return levels({middles.data(), static_cast<std::size_t>(times.stop_bit + 1)}, listener);
}

/// The levels at instants in ascending order, that of the first instant in bit 0.
unsigned Line::levels(std::span<const Time> at, int listener) const {
  if (irregular()) return sampled(at, listener);
  if (std::ranges::equal(answers_.levels_at, at)) return answers_.levels;
  answers_.levels_at.assign(at.begin(), at.end());
  return answers_.levels = sampled(at, listener);
}

unsigned Line::sampled(std::span<const Time> at, int listener) const {
  unsigned levels = ~0U;
  if (!irregular()) {
    each_busy([&](const Driver& driver) { levels &= driver.levels(at); });
  } else {
    for (std::size_t i = 0; i < at.size(); ++i)
      if (!irregular_level(at[i], listener)) levels &= ~(1U << i);
  }
  return levels;
}

bool Line::driven_level(Time at, std::uint32_t audible) const {
  bool mark = true;
  each_busy([&](const Driver& driver) { mark = mark && driver.level(at); }, audible);
  return mark;
}

bool Line::disturbed_level(bool mark, Time at) const {
  using Effect = Disturbance::Effect;
  if (periods(Effect::Cuts).lasts(at)) return true;
  return mark != periods(Effect::Inverts).lasts(at) && !periods(Effect::HoldsSpace).lasts(at);
}

bool Line::level_of(int driver, Time at) const {
  reveal();
  const auto number = static_cast<std::size_t>(driver);
  return number >= drivers_.all.size() || drivers_.all[number].level(at);
}

bool Line::level_without(int driver, Time at) const {
  if (implied_.any() && implied_.driver == driver) return true;  // it is alone
  return disturbed_level(driven_level(at, audible(driver, at) & ~(1U << driver)) || chance_says_mark(at, driver), at);
}

int Line::space_holder_of(std::uint32_t drivers, Time at) const {
  reveal();
  for (std::uint32_t those = busy_ & drivers; those != 0; those &= those - 1)
    if (const int driver = std::countr_zero(those); !level_of(driver, at)) return driver;
  return kNobody;
}

Time Line::next_change(Time from) const {
  Time change = kNever;
  each_busy([&](const Driver& driver) {
    const std::size_t index = driver.edges_until(from - 1);
    if (index < driver.edges.size()) change = std::min(change, driver.edges[index]);
  });
  for (const Periods& those : disturbances_) change = std::min(change, those.next_change(from));
  for (const Periods& those : contention_.marks) change = std::min(change, those.next_change(from));
  return std::min(change, next_separation(from));
}

Time Line::falling_edge(Time from, int listener) const {
  if (implied_.any() && from <= implied_.start) return implied_.start;
  if (implied_.any() && from >= implied_.last_edge) return kNever;
  if (irregular()) return irregular_falling_edge(from, listener);
  if (answers_.falling_from == from) return answers_.falling_edge;
  const Time edge = driven_falling_edge(from);
  answers_.falling_from = from;
  return answers_.falling_edge = edge;
}

Time Line::driven_falling_edge(Time from) const {
  for (;;) {
    Time edge = kNever;
    each_busy([&](const Driver& driver) { edge = std::min(edge, driver.next_edge(from, false)); });
    if (edge == kNever) return kNever;
    const Time held = space_held_from_before(edge);
    if (held < edge) return edge;
    if (held == kNever) return kNever;
    from = held + 1;
  }
}

/// Whatever changes the level is looked at in the order of time.
Time Line::irregular_falling_edge(Time from, int listener) const {
  for (;;) {
    const Time change = next_change(from);
    if (change == kNever) return kNever;
    if (!irregular_level(change, listener) && irregular_level(change - 1, listener)) return change;
    from = change + 1;
  }
}

/// The end of the space that drivers already at space just before `edge` hold; earlier than `edge` if there is no such
/// driver.
Time Line::space_held_from_before(Time edge) const {
  Time held = edge - 1;
  each_busy([&](const Driver& driver) {
    if (!driver.level(edge - 1)) held = std::max(held, driver.next_edge(edge, true));
  });
  return held;
}

void Line::forget(Time now) {
  const bool nothing = may_imply(), all_to_come = implied_.any() && now <= implied_.last_edge;
  if (nothing || all_to_come) return;
  for (const LineListener* listener : wiring_.listeners) now = std::min(now, listener->needs_from());
  if (implied_.any() && now <= implied_.last_edge) return;
  implied_.driver = Implied::kNone;
  for (std::uint32_t those = busy_; those != 0; those &= those - 1) {
    const auto number = static_cast<std::size_t>(std::countr_zero(those));
    drivers_.all[number].forget(now);
    changed(static_cast<int>(number));
  }
  changed();
  while (separations_.size() > 1 && separations_[1].at <= now) separations_.erase(separations_.begin());
  if (separations_.size() == 1 && separations_[0].far == 0 && separations_[0].at <= now) separations_.clear();
  if (!disturbed_) return;
  for (Periods& those : disturbances_) those.forget(now);
  for (Periods& those : contention_.marks) those.forget(now);
  note_whether_disturbed();
}

bool Line::operator==(const Line& other) const {
  reveal();
  other.reveal();
  return drivers_ == other.drivers_ && separations_ == other.separations_ && contention_ == other.contention_ &&
         disturbances_ == other.disturbances_;
}

void Line::attach(LineListener& listener) {
  wiring_.listeners.push_back(&listener);
  note_whether_watched();
}

void Line::detach(LineListener& listener) {
  std::erase(wiring_.listeners, &listener);
  note_whether_watched();
}

void Line::note_whether_watched() {
  wiring_.watched = std::ranges::any_of(wiring_.listeners, &LineListener::waits_for_settled_levels);
}

void Line::tell(Time at) const {
  for (LineListener* listener : wiring_.listeners) listener->line_changed(at);
}

}  // namespace s7200::serial
