// wait: nothing is sent for so long, for so many scans, or until a moment.
#pragma once

#include "tools/scenario/steps/steps.hpp"

namespace s7200::tools {

struct WaitStep final : StepAction {
  Span time{};
  std::uint64_t scans = 0;      ///< instead of a time
  std::optional<Time> until{};  ///< the same: since power-up

  Needs needs() const override { return scans != 0 ? Needs::ToChange : Needs::Line; }
  void act(Run& run) const override;
  void wait_until(Run& run) const;
  bool write(TranscriptWriter& writer) const override;
};

}  // namespace s7200::tools
