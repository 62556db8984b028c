#include "tools/session/causes/line/line_faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "interpreter/base/text/counted.hpp"
#include "tools/session/past/past_words.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools {
namespace {

/// Of a whole exchange.
bool lasts_all_along(const serial::Fault& fault) {
  return fault.kind == serial::FaultKind::Echo || fault.kind == serial::FaultKind::Baud;
}

/// `from 2000.000000 ms to 2004.000000 ms`, `since 2000.000000 ms`
std::string period_text(Time from, Time to) {
  if (to == kNever) return fmt::format("since {}", moment_text(from));
  return fmt::format("from {} to {}", moment_text(from), moment_text(to));
}

/// `character 2`, `characters 2, 5 and 7`; the last ones are counted if they are many.
std::string numbers_text(const std::vector<std::uint32_t>& numbers) {
  constexpr std::size_t kNamed = 4;
  std::vector<std::string> names;
  for (const std::uint32_t number : numbers) names.push_back(fmt::to_string(number));
  if (names.size() > kNamed + 1) {
    names.resize(kNamed);
    names.push_back(fmt::format("{} more", numbers.size() - kNamed));
  }
  return noun(numbers.size(), "character") + " " + list_text(names);
}

}  // namespace

void LineFaults::begin() {
  const Time now = history_.station(0).system().now();
  for (const serial::Faults::Injected& injected : line_.faults().state().injected)
    if (injected.last_end > now)
      happenings_.push_back({injected.fault, injected.driver, {.from = injected.last_begin, .to = injected.last_end}});
  note_cable();
  line_.faults().set_watcher(this);
}

void LineFaults::note_cable() {
  const Time now = history_.station(0).system().now();
  separations_.push_back(line_.line().separation(now).value_or(serial::Line::Separation{.at = now}));
}

void LineFaults::fault_happens(const serial::Faults::Injected& fault, const serial::FaultHappening& what) {
  happenings_.push_back({fault.fault, fault.driver, what});
}

void LineFaults::faults_cleared(Time at) {
  for (Happening& one : happenings_) one.what.to = std::min(one.what.to, at);
}

bool LineFaults::at_work(Time at) const {
  return std::ranges::any_of(happenings_, [&](const Happening& one) { return one.what.from <= at && at < one.what.to; });
}

bool LineFaults::has_pause(Time from, Time to) const {
  return std::ranges::any_of(happenings_, [&](const Happening& one) {
    return one.fault.kind == serial::FaultKind::Gap && one.what.from >= from && one.what.to <= to;
  });
}

/// Each where it was sent: gaps and extra characters push those behind them on.
std::vector<LineFaults::Span> LineFaults::characters_of(const Span& frame) const {
  const auto pushes = [&](const Happening& one, std::size_t number, bool is_before) {
    const bool is_gap = one.fault.kind == serial::FaultKind::Gap, is_extra = one.fault.kind == serial::FaultKind::Extra;
    const bool in_front = is_gap || one.fault.character == 0U;
    return (is_gap || is_extra) && one.what.character == number && in_front == is_before && one.what.from >= frame.from &&
           one.what.from < frame.to;
  };
  Time pauses = 0;
  std::uint64_t sent = frame.characters;
  for (std::size_t number = 1; number <= frame.characters; ++number)
    for (const Happening& one : happenings_) {
      if (!pushes(one, number, true) && !pushes(one, number, false)) continue;
      if (one.fault.kind == serial::FaultKind::Gap)
        pauses += one.what.to - one.what.from;
      else
        sent += one.what.times;
    }
  const Time filled = frame.to - frame.from - pauses;
  const Time character = frame.character != 0 || sent == 0 ? frame.character : filled / static_cast<Time>(sent);
  const auto length = [&](const Happening& one) {
    const bool is_gap = one.fault.kind == serial::FaultKind::Gap;
    return is_gap ? one.what.to - one.what.from : static_cast<Time>(one.what.times) * character;
  };
  std::vector<Span> characters;
  Time at = frame.from;
  for (std::size_t number = 1; number <= frame.characters; ++number) {
    for (const Happening& one : happenings_)
      if (pushes(one, number, true)) at += length(one);
    characters.push_back({.from = at, .to = at + character, .characters = 1});
    at += character;
    for (const Happening& one : happenings_)
      if (pushes(one, number, false)) at += length(one);
  }
  return characters;
}

/// What disturbs the wire strikes whatever is sent then; half a bit at the end of a character is none of it.
std::vector<std::uint32_t> LineFaults::struck(const Happening& one, const Span& frame) const {
  const bool has_place = one.what.character != 0 && one.what.from >= frame.from;
  const bool on_wire = one.fault.kind == serial::FaultKind::Collision || one.fault.kind == serial::FaultKind::Break ||
                       one.fault.kind == serial::FaultKind::Glitch;
  if (!has_place) return {};
  if (!on_wire) return {one.what.character};
  std::vector<std::uint32_t> numbers;
  const std::vector<Span> all = characters_of(frame);
  for (std::uint32_t number = 1; number <= all.size(); ++number) {
    const Span& character = all[number - 1];
    const Time common = std::min(character.to, one.what.to) - std::max(character.from, one.what.from);
    const Time least = std::min(one.what.to - one.what.from, (character.to - character.from) / 20);
    if (common >= least) numbers.push_back(number);
  }
  return numbers;
}

std::string LineFaults::note_of(const std::vector<const Happening*>& all, const Span& frame) const {
  const Happening& first = *all.front();
  std::uint64_t times = 0;
  std::vector<std::uint32_t> characters;
  for (const Happening* one : all) {
    times += one->what.times;
    for (const std::uint32_t number : struck(*one, frame))
      if (std::ranges::find(characters, number) == characters.end()) characters.push_back(number);
  }
  std::ranges::sort(characters);
  std::string note = "fault " + serial::to_text(first.fault);
  if (first.driver != serial::Faults::kAnyDriver) note += " of " + history_.name_at(line_, first.driver);
  note += fmt::format(": {}×", times);
  if (first.fault.kind == serial::FaultKind::Answer) return note;  // it is of the whole frame
  const bool is_extra = first.fault.kind == serial::FaultKind::Extra;
  const std::string_view where = !is_extra ? "in" : first.fault.character == 0U ? "in front of" : "behind";
  if (!characters.empty() && characters.size() < frame.characters)
    note += fmt::format(", {} {}", where, numbers_text(characters));
  if (characters.empty() && !lasts_all_along(first.fault))
    note += fmt::format(", {}{}", all.size() > 1 ? "first " : "", period_text(first.what.from, first.what.to));
  return note;
}

std::vector<std::string> LineFaults::in(const Span& frame, const Span& asked) const {
  std::vector<std::string> notes;
  std::vector<const Happening*> of_one;
  const auto strikes = [&](const Happening& one) {
    const auto [from, to] = std::pair(one.what.from, one.what.to);
    if (lasts_all_along(one.fault)) return from >= asked.from && from < asked.to;
    return from < frame.to && to > frame.from;
  };
  const bool others_strike = std::ranges::any_of(
      happenings_, [&](const Happening& one) { return one.fault.kind != serial::FaultKind::Echo && strikes(one); });
  for (auto one = happenings_.begin(); one != happenings_.end(); ++one) {
    if (one->fault.kind == serial::FaultKind::Echo && others_strike) continue;
    const auto is_same = [&](const Happening& other) { return other.fault == one->fault && other.driver == one->driver; };
    if (std::any_of(happenings_.begin(), one, is_same)) continue;
    of_one.clear();
    for (auto other = one; other != happenings_.end(); ++other)
      if (is_same(*other) && strikes(*other)) of_one.push_back(&*other);
    if (!of_one.empty()) notes.push_back(note_of(of_one, frame));
  }
  return notes;
}

std::string LineFaults::cut_between(int driver, int other, Time from, Time to) const {
  const auto bit = [](int one) { return 1U << static_cast<unsigned>(one); };
  for (std::size_t i = 0; i < separations_.size(); ++i) {
    const auto& [at, far] = separations_[i];
    const Time until = i + 1 < separations_.size() ? separations_[i + 1].at : kNever;
    const bool parts = ((far & bit(driver)) == 0) != ((far & bit(other)) == 0);
    if (at < to && until > from && parts)
      return fmt::format("{} cut {}", until == kNever ? "has been" : "was", period_text(at, until));
  }
  return {};
}

}  // namespace s7200::tools
