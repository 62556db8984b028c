// Which instruction has enabled or disabled interrupts.
#pragma once

#include <optional>

#include "interpreter/trace/trace.hpp"

namespace s7200 {

/// Of ENI and DISI, each an Enable record: one that follows another of its kind has changed nothing, so that of several DISI
/// in a row the first one counts. `enabled`: how such an instruction has left interrupts last; nothing if none has since the
/// CPU went to RUN, which leaves them disabled, or if that is not known.
constexpr bool changes_interrupts(const TraceRecord& record, std::optional<bool> enabled) {
  return enabled != (record.code == 1);
}

}  // namespace s7200
