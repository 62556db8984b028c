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

}  // namespace

RunDifferences::RunDifferences(const RunRecord& first, const RunRecord& second, Time end)
    : tolerance_(2 * std::max(first.longest_scan, second.longest_scan) + 100 * kMicrosecond) {
  for (const auto& [key, turns] : first.series) compare(key, turns, turns_of(second, key), end);
  for (const auto& [key, turns] : second.series)
    if (!first.series.contains(key)) compare(key, kNoTurns, turns, end);
  std::ranges::sort(all_, [](const RunDifference& a, const RunDifference& b) {
    return std::tuple(a.at, !a.in_first, a.happening, a.key) < std::tuple(b.at, !b.in_first, b.happening, b.key);
  });
}

void RunDifferences::compare(SeriesKey key, const std::vector<Turn>& first, const std::vector<Turn>& second, Time end) {
  std::size_t i = 0, j = 0;
  std::vector<Time> only;
  const auto add = [&](const Turn& turn, bool in_first) {
    if (turn.at > end) return;
    only.push_back(turn.at);
    all_.push_back({turn.at, in_first, turn.happening, key});
  };
  while (i < first.size() || j < second.size()) {
    if (i == first.size()) {
      add(second[j++], false);
    } else if (j == second.size()) {
      add(first[i++], true);
    } else {
      const Turn &a = first[i], &b = second[j];
      const Time apart = std::max(a.at, b.at) - std::min(a.at, b.at);
      if (a.value == b.value && apart <= tolerance_) {
        ++i, ++j;
      } else if (a.at <= b.at) {
        add(first[i++], true);
      } else {
        add(second[j++], false);
      }
    }
  }
  if (!only.empty()) turns_.emplace(key, std::move(only));
}

bool RunDifferences::differ(SeriesKey key, Time at) const {
  const auto found = turns_.find(key);
  if (found == turns_.end()) return false;
  const std::vector<Time>& turns = found->second;
  const auto after = std::ranges::upper_bound(turns, at) - turns.begin();
  if (after == 0) return false;
  return after % 2 == 1 || turns[static_cast<std::size_t>(after) - 1] + tolerance_ >= at;
}

bool RunDifferences::differ_at_the_end(SeriesKey key) const {
  const auto found = turns_.find(key);
  return key < kFirstRecord && found != turns_.end() && found->second.size() % 2 == 1;
}

}  // namespace s7200::tools
