// The execution times of several CPUs, for a verb that takes programs for each.
#pragma once

#include <map>
#include <optional>

#include "tools/command/options/plc/program_options.hpp"

namespace s7200::tools {

/// As --times has them, read once for each CPU: a table may come from a pipe.
class TablesByCpu {
 public:
  /// The options outlive it.
  explicit TablesByCpu(const CpuOptions& options) : options_(options) {}

  /// Null after a message.
  const TimeTable* of(const CpuModel& model) {
    const auto [found, added] = tables_.try_emplace(&model);
    if (added) found->second = options_.times(model);
    return found->second ? &*found->second : nullptr;
  }

 private:
  const CpuOptions& options_;
  std::map<const CpuModel*, std::optional<TimeTable>> tables_;
};

}  // namespace s7200::tools
