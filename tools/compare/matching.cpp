#include "tools/compare/matching.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <map>
#include <sstream>

namespace s7200::tools {
namespace {

constexpr std::size_t kMostCells = 4'000'000;  ///< of a table of common rows
constexpr std::size_t kMostPairs = 400'000;    ///< of networks whose likeness is worked out across routines
constexpr double kAlike = 0.5;

class Matching {
 public:
  Matching(const std::vector<ComparedNetwork>& older, const std::vector<ComparedNetwork>& newer)
      : older_(older), newer_(newer), of_older_(older.size()), of_newer_(newer.size()) {}

  std::vector<NetworkMatch> result() {
    const auto code = [](const ComparedNetwork& n) { return fmt::format("{}", fmt::join(n.code, "\n")); };
    pair_by([&](const ComparedNetwork& n) { return n.routine + "\n" + code(n); });
    mark_moved();
    pair_by(code);
    pair_by([](const ComparedNetwork& n) { return n.title.empty() ? "" : n.routine + "\n" + n.title; });
    pair_alike();
    return in_order();
  }

 private:
  using Key = std::function<std::string(const ComparedNetwork&)>;

  void pair(std::size_t o, std::size_t n) {
    of_older_[o] = n;
    of_newer_[n] = o;
  }

  /// The first with a key belongs to the first with the same one, the second to the second; an empty key is none.
  void pair_by(const Key& key) {
    std::map<std::string, std::vector<std::size_t>> waiting;
    for (std::size_t o = older_.size(); o-- > 0;)
      if (!of_older_[o]) waiting[key(older_[o])].push_back(o);
    waiting.erase("");
    for (std::size_t n = 0; n < newer_.size(); ++n) {
      if (of_newer_[n]) continue;
      const auto found = waiting.find(key(newer_[n]));
      if (found == waiting.end() || found->second.empty()) continue;
      pair(found->second.back(), n);
      found->second.pop_back();
    }
  }

  /// Of the pairs of each routine all but the longest row in the same order have moved.
  void mark_moved() {
    std::map<std::string, std::vector<std::size_t>> rows;
    for (std::size_t o = 0; o < older_.size(); ++o)
      if (of_older_[o]) rows[older_[o].routine].push_back(o);
    moved_.assign(older_.size(), false);
    for (const auto& [routine, row] : rows) {
      mark_moved(row);
      std::ranges::copy_if(row, std::back_inserter(stayed_), [&](std::size_t o) { return !moved_[o]; });
    }
  }

  void mark_moved(const std::vector<std::size_t>& row) {
    std::vector<std::size_t> ends;               // of the best row of each length: its last network
    std::map<std::size_t, std::size_t> earlier;  // in that row
    for (const std::size_t o : row) {
      moved_[o] = true;
      const auto place = std::lower_bound(ends.begin(), ends.end(), o,
                                          [&](std::size_t a, std::size_t b) { return *of_older_[a] < *of_older_[b]; });
      if (place != ends.begin()) earlier[o] = *std::prev(place);
      if (place == ends.end())
        ends.push_back(o);
      else
        *place = o;
    }
    if (ends.empty()) return;
    std::size_t o = ends.back();
    for (moved_[o] = false; earlier.contains(o); moved_[o] = false) o = earlier.at(o);
  }

  static std::vector<std::string> words(const ComparedNetwork& network) {
    std::vector<std::string> all;
    for (const std::string& instruction : network.code) {
      std::istringstream text(instruction);
      for (std::string word; text >> word;) all.push_back(word);
    }
    std::sort(all.begin(), all.end());
    return all;
  }

  static double likeness(const std::vector<std::string>& a, const std::vector<std::string>& b) {
    std::vector<std::string> both;
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
    return a.empty() && b.empty() ? 0 : 2.0 * static_cast<double>(both.size()) / static_cast<double>(a.size() + b.size());
  }

  void pair_alike() {
    struct Alike {
      double likeness = 0;
      bool elsewhere = false;
      std::size_t o = 0, n = 0;
    };
    std::map<std::size_t, std::vector<std::string>> older, newer;
    for (std::size_t o = 0; o < older_.size(); ++o)
      if (!of_older_[o]) older.emplace(o, words(older_[o]));
    for (std::size_t n = 0; n < newer_.size(); ++n)
      if (!of_newer_[n]) newer.emplace(n, words(newer_[n]));
    const bool anywhere = older.size() * newer.size() <= kMostPairs;
    std::vector<Alike> all;
    for (const auto& [o, words_of_older] : older)
      for (const auto& [n, words_of_newer] : newer) {
        const bool elsewhere = older_[o].routine != newer_[n].routine;
        if (elsewhere && !anywhere) continue;
        const double alike = likeness(words_of_older, words_of_newer);
        if (alike >= kAlike) all.push_back({alike, elsewhere, o, n});
      }
    std::stable_sort(all.begin(), all.end(), [](const Alike& a, const Alike& b) {
      return a.likeness != b.likeness ? a.likeness > b.likeness : a.elsewhere < b.elsewhere;
    });
    for (const Alike& alike : all)
      if (!of_older_[alike.o] && !of_newer_[alike.n]) pair(alike.o, alike.n);
  }

  /// What is only alike has moved if a network that stayed is before it in one program and after it in the other.
  bool moved(std::size_t o, std::size_t n) const {
    if (moved_[o] || older_[o].routine != newer_[n].routine) return true;
    const auto crosses = [&](std::size_t stayed) {
      return older_[stayed].routine == older_[o].routine && (stayed < o) != (*of_older_[stayed] < n);
    };
    return std::ranges::any_of(stayed_, [&](std::size_t stayed) { return stayed != o && crosses(stayed); });
  }

  std::vector<NetworkMatch> in_order() const {
    std::vector<NetworkMatch> all;
    std::size_t next = 0;  // of the old program
    const auto removed_before = [&](std::size_t o) {
      for (; next < o; ++next)
        if (!of_older_[next]) all.push_back({next, {}, false, false});
    };
    for (std::size_t n = 0; n < newer_.size(); ++n) {
      const auto o = of_newer_[n];
      if (o && !moved(*o, n)) removed_before(*o);
      if (o)
        all.push_back({o, n, older_[*o].code == newer_[n].code, moved(*o, n)});
      else
        all.push_back({{}, n, false, false});
    }
    removed_before(older_.size());
    return all;
  }

  const std::vector<ComparedNetwork>&older_, &newer_;
  std::vector<std::optional<std::size_t>> of_older_, of_newer_;  // the other one of each
  std::vector<std::size_t> stayed_;                              // by number in the old program
  std::vector<bool> moved_;                                      // by number in the old program
};

}  // namespace

std::vector<NetworkMatch> match_networks(const std::vector<ComparedNetwork>& older,
                                         const std::vector<ComparedNetwork>& newer) {
  return Matching(older, newer).result();
}

std::vector<std::pair<std::size_t, std::size_t>> common_row(const std::vector<std::string>& older,
                                                            const std::vector<std::string>& newer) {
  std::vector<std::pair<std::size_t, std::size_t>> row, tail;
  std::size_t begin = 0, o_end = older.size(), n_end = newer.size();
  for (; begin < o_end && begin < n_end && older[begin] == newer[begin]; ++begin) row.emplace_back(begin, begin);
  for (; o_end > begin && n_end > begin && older[o_end - 1] == newer[n_end - 1]; --o_end, --n_end)
    tail.emplace_back(o_end - 1, n_end - 1);
  const std::size_t o_count = o_end - begin, n_count = n_end - begin;
  if (o_count * n_count <= kMostCells) {
    // longest[o][n]: of what follows there.
    std::vector<std::vector<std::size_t>> longest(o_count + 1, std::vector<std::size_t>(n_count + 1));
    for (std::size_t o = o_count; o-- > 0;)
      for (std::size_t n = n_count; n-- > 0;)
        longest[o][n] = older[begin + o] == newer[begin + n] ? longest[o + 1][n + 1] + 1
                                                             : std::max(longest[o + 1][n], longest[o][n + 1]);
    for (std::size_t o = 0, n = 0; o < o_count && n < n_count;) {
      if (older[begin + o] == newer[begin + n])
        row.emplace_back(begin + o++, begin + n++);
      else
        longest[o + 1][n] >= longest[o][n + 1] ? ++o : ++n;
    }
  }
  row.insert(row.end(), tail.rbegin(), tail.rend());
  return row;
}

}  // namespace s7200::tools
