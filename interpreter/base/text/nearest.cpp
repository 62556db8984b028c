#include "interpreter/base/text/nearest.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace s7200 {
namespace {

constexpr std::size_t kLongestWord = 24, kMostChanges = 2;

/// Edit distance, where two neighbours that have changed places are one change. Both words are short.
std::size_t distance(std::string_view a, std::string_view b) {
  using Row = std::array<std::uint8_t, kLongestWord + kMostChanges + 1>;
  std::array<Row, kLongestWord + 1> rows{};
  for (std::size_t j = 0; j <= b.size(); ++j) rows[0][j] = static_cast<std::uint8_t>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    Row& row = rows[i];
    const Row& last = rows[i - 1];
    row[0] = static_cast<std::uint8_t>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      int changes = std::min({last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1), last[j] + 1, row[j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        changes = std::min(changes, rows[i - 2][j - 2] + 1);
      row[j] = static_cast<std::uint8_t>(changes);
    }
  }
  return rows[a.size()][b.size()];
}

/// The set of letters in a word, a bit for each kind.
std::uint64_t letters_of(std::string_view word) {
  std::uint64_t letters = 0;
  for (const char c : word) letters |= std::uint64_t{1} << (static_cast<unsigned char>(c) % 64);
  return letters;
}

}  // namespace

std::vector<std::string_view> all_nearest(std::string_view word, std::span<const std::string_view> known,
                                          std::size_t most_changes) {
  std::vector<std::string_view> found;
  if (word.size() < 2 || word.size() > kLongestWord) return found;
  std::size_t best = std::min(most_changes, kMostChanges);
  const std::uint64_t letters = letters_of(word);
  for (const std::string_view candidate : known) {
    // A change adds one letter and takes one away at most; the length changes by one at most.
    if (std::max(word.size(), candidate.size()) - std::min(word.size(), candidate.size()) > best) continue;
    if (static_cast<std::size_t>(std::popcount(letters ^ letters_of(candidate))) > 2 * best) continue;
    const std::size_t changes = distance(word, candidate);
    if (changes > best) continue;
    if (changes < best) found.clear();
    best = changes;
    found.push_back(candidate);
  }
  return found;
}

std::string_view nearest(std::string_view word, std::span<const std::string_view> known) {
  const auto found = all_nearest(word, known, word.size() < 4 ? 1 : kMostChanges);
  return found.empty() ? std::string_view() : found.front();
}

}  // namespace s7200
