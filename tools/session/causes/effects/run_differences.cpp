#include "tools/session/causes/effects/run_differences.hpp"

#include <algorithm>
#include <tuple>

namespace s7200::tools {
namespace {

const std::vector<Turn> kNoTurns{};

const std::vector<Turn>& turns_of(const RunRecord& run, SeriesKey key) {
  const auto turns = run.series.find(key);
  return turns == run.series.end() ? kNoTurns : turns->second;
}

/// Walks through both series in order of time. `same(a, b)` is a turn that both runs have, `only(turn, in_first)` one that
/// only one of them has.
template <typename Same, typename Only>
void walk(const std::vector<Turn>& first, const std::vector<Turn>& second, Time tolerance, const Same& same,
          const Only& only) {
  std::size_t i = 0, j = 0;
  while (i < first.size() || j < second.size()) {
    const bool both = i < first.size() && j < second.size();
    const Time apart = both ? std::max(first[i].at, second[j].at) - std::min(first[i].at, second[j].at) : Time{0};
    if (both && first[i].value == second[j].value && apart <= tolerance)
      same(first[i++], second[j++]);
    else if (j == second.size() || (both && first[i].at <= second[j].at))
      only(first[i++], true);
    else
      only(second[j++], false);
  }
}

}  // namespace

RunDifferences::RunDifferences(const RunRecord& first, const RunRecord& second, Time end)
    : first_(first),
      second_(second),
      end_(end),
      tolerance_(2 * std::max(first.longest_scan, second.longest_scan) + 100 * kMicrosecond) {
  const auto compare_either = [&](SeriesKey key, const std::vector<Turn>& a, const std::vector<Turn>& b) {
    key < kFirstRecord ? compare(key, a, b) : compare_records(key, a, b);
  };
  for (const auto& [key, turns] : first.series) compare_either(key, turns, turns_of(second, key));
  for (const auto& [key, turns] : second.series)
    if (!first.series.contains(key)) compare_either(key, kNoTurns, turns);
  std::ranges::sort(all_, [](const RunDifference& a, const RunDifference& b) {
    return std::tuple(a.at, !a.in_first, a.happening, a.key) < std::tuple(b.at, !b.in_first, b.happening, b.key);
  });
}

void RunDifferences::compare_records(SeriesKey key, const std::vector<Turn>& first, const std::vector<Turn>& second) {
  walk(
      first, second, tolerance_, [](const Turn&, const Turn&) {},
      [&](const Turn& turn, bool in_first) { add(key, turn, in_first, true); });
}

/// A power flow that neither of the runs has come to yet is none.
void RunDifferences::compare(SeriesKey key, const std::vector<Turn>& first, const std::vector<Turn>& second) {
  const std::uint64_t bit = bit_of(key);
  const bool at_first = is_memory(key) && (first_.image[bit / 8] >> (bit % 8) & 1) != 0;
  bool a = at_first, b = at_first;
  std::vector<Change> changes;
  const auto note = [&](Time at, bool differ) {
    if ((changes.empty() ? false : changes.back().differ) == differ) return;
    changes.push_back({changes.empty() ? at : std::max(at, changes.back().at), differ});
  };
  const auto same = [&](const Turn& of_first, const Turn& of_second) {
    a = b = of_first.value;
    note(std::max(of_first.at, of_second.at), false);
  };
  const auto only = [&](const Turn& turn, bool in_first) {
    (in_first ? a : b) = turn.value;
    if (turn.at > end_ || !can_be_compared(key, turn, in_first ? second_ : first_)) return;
    const bool differed = !changes.empty() && changes.back().differ;
    if (a == b && !differed) return;
    add(key, turn, in_first, a != b);
    note(turn.at, a != b);
  };
  walk(first, second, tolerance_, same, only);
  if (changes.empty()) return;
  changes_.emplace(key, std::move(changes));
  if (is_memory(key)) keys_of_bit_[bit].push_back(key);
}

/// Between scans, and of power flow, always.
bool RunDifferences::can_be_compared(SeriesKey key, const Turn& turn, const RunRecord& other) const {
  if (!is_memory(key) || point_of(key) == kBetweenScans) return true;
  return other.passes_about(op_at(point_of(key)), turn.seen, tolerance_);
}

void RunDifferences::add(SeriesKey key, const Turn& turn, bool in_first, bool opens) {
  if (turn.at <= end_) all_.push_back({turn.at, in_first, turn.happening, key, turn.value, opens});
}

bool RunDifferences::differ(SeriesKey key, Time at) const {
  const auto found = changes_.find(key);
  if (found == changes_.end()) return false;
  const auto after = std::ranges::upper_bound(found->second, at, {}, &Change::at);
  if (after == found->second.begin()) return false;
  const Change& last = *(after - 1);
  return last.differ || last.at + tolerance_ >= at;
}

bool RunDifferences::differ_somewhere(std::uint64_t bit, Time at) const {
  const auto keys = keys_of_bit_.find(bit);
  return keys != keys_of_bit_.end() && std::ranges::any_of(keys->second, [&](SeriesKey key) { return differ(key, at); });
}

/// At a point of the program only if it is passed still.
bool RunDifferences::differ_at_the_end(SeriesKey key) const {
  const auto found = changes_.find(key);
  if (found == changes_.end() || !found->second.back().differ) return false;
  if (!is_memory(key) || point_of(key) == kBetweenScans) return true;
  const std::uint32_t op = op_at(point_of(key));
  return first_.passes_about(op, end_, tolerance_) && second_.passes_about(op, end_, tolerance_);
}

}  // namespace s7200::tools
