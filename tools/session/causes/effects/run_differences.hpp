// In what two runs of a PLC differ that began alike.
//
// Each series of the one is compared with that of the other: the same turn at about the same time is no difference. Scans of
// different lengths move everything that a program does by up to a scan, so "about" is two of the longest scans. Points of
// the program that only one of the runs passes say nothing of memory, which is compared between scans too.
#pragma once

#include <cstddef>
#include <optional>
#include <unordered_map>
#include <vector>

#include "tools/session/causes/effects/run_record.hpp"

namespace s7200::tools {

/// A turn that only one of the runs has.
struct RunDifference {
  Time at = 0;
  bool in_first = true;
  std::size_t happening = 0;  ///< in that run
  SeriesKey key = 0;
  bool value = true;  ///< that it has in that run from then on
  bool opens = true;  ///< the runs differ in it from then on; otherwise they have the same again
};

class RunDifferences {
 public:
  /// Differences up to `end`. The runs go on a little longer: a turn just before it may have its counterpart after it. Both
  /// must live as long as this.
  RunDifferences(const RunRecord& first, const RunRecord& second, Time end);

  /// In order of time.
  const std::vector<RunDifference>& all() const { return all_; }

  /// Two of the longest scans.
  Time tolerance() const { return tolerance_; }

  /// Whether a bit at a point or a power flow differs then, or did within two scans before.
  bool differ(SeriesKey key, Time at) const;
  /// The same of a bit wherever it is looked at.
  bool differ_somewhere(std::uint64_t bit, Time at) const;

  /// Whether it differs still at the end; of a record never.
  bool differ_at_the_end(SeriesKey key) const;

 private:
  /// From when on they differ in a series, or have the same again.
  struct Change {
    Time at = 0;
    bool differ = false;
  };

  void compare(SeriesKey key, const std::vector<Turn>& first, const std::vector<Turn>& second);
  void compare_records(SeriesKey key, const std::vector<Turn>& first, const std::vector<Turn>& second);
  bool can_be_compared(SeriesKey key, const Turn& turn, const RunRecord& other) const;
  void add(SeriesKey key, const Turn& turn, bool in_first, bool opens);

  const RunRecord &first_, &second_;
  Time end_, tolerance_;
  std::vector<RunDifference> all_{};
  std::unordered_map<SeriesKey, std::vector<Change>> changes_{};
  std::unordered_map<std::uint64_t, std::vector<SeriesKey>> keys_of_bit_{};
};

}  // namespace s7200::tools
