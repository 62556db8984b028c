// wait: nothing is sent for so long, or for so many scans.
#pragma once

#include "tools/scenario/steps/steps.hpp"

namespace s7200::tools {

struct WaitStep final : Action {
  Span time{};
  std::uint64_t scans = 0;  ///< instead of a time

  Needs needs() const override { return scans != 0 ? Needs::ToChange : Needs::Line; }
  void act(Run& run) const override;
  bool write(TranscriptWriter& writer) const override;
};

}  // namespace s7200::tools
