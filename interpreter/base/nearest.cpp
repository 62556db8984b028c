#include "interpreter/base/nearest.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace s7200 {
namespace {

/// Edit distance, where two neighbours that have changed places are one change.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_last, last, row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before_last = std::exchange(last, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1), last[j] + 1, row[j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
  }
  return row.back();
}

}  // namespace

std::string_view nearest(std::string_view word, std::span<const std::string_view> known) {
  if (word.size() < 2 || word.size() > 12) return {};
  std::string_view found;
  std::size_t best = word.size() < 4 ? 2 : 3;  // this many changes are too many
  for (const std::string_view candidate : known) {
    const std::size_t length = candidate.size();
    if (std::max(length, word.size()) - std::min(length, word.size()) >= best) continue;  // needs at least that many changes
    const std::size_t changes = distance(word, candidate);
    if (changes >= best) continue;
    best = changes;
    found = candidate;
  }
  return found;
}

}  // namespace s7200
