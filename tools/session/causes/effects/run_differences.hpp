// In what two runs of a PLC differ that began alike.
//
// Each series of the one is compared with that of the other: the same turn at about the same time is no difference. Scans of
// different lengths move everything that a program does by up to a scan, so "about" is two of the longest scans.
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
};

class RunDifferences {
 public:
  /// Differences up to `end`. The runs go on a little longer: a turn just before it may have its counterpart after it.
  RunDifferences(const RunRecord& first, const RunRecord& second, Time end);

  /// In order of time.
  const std::vector<RunDifference>& all() const { return all_; }

  /// Whether a bit or a power flow differs then, or did within two scans before.
  bool differ(SeriesKey key, Time at) const;

  /// Whether it differs still at the end; of a record never.
  bool differ_at_the_end(SeriesKey key) const;

 private:
  void compare(SeriesKey key, const std::vector<Turn>& first, const std::vector<Turn>& second, Time end);

  Time tolerance_;
  std::vector<RunDifference> all_{};
  std::unordered_map<SeriesKey, std::vector<Time>>
      turns_{};  // that only one has: from the first to the second they differ …
};

}  // namespace s7200::tools
