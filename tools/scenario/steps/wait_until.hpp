// wait_until: goes on when memory is as expected, looked at now, at the end of each scan, and when the time is over.
#pragma once

#include <vector>

#include "tools/scenario/reading/memory_values.hpp"
#include "tools/scenario/steps/steps.hpp"

namespace s7200::tools {

struct WaitUntilStep final : StepAction {
  std::vector<MemoryExpected> expected{};
  std::optional<Time> timeout{};  ///< the scenario's if not given

  Needs needs() const override { return Needs::ToChange; }
  void act(Run& run) const override;
  bool write(TranscriptWriter& writer) const override;
};

}  // namespace s7200::tools
