// receive: a transmission that no one asked for, since the last request or still to come.
#pragma once

#include "tools/scenario/steps/expected/reception.hpp"

namespace s7200::tools {

struct ReceiveStep final : Reception {
  std::optional<Window> at{};  ///< when it begins, since power-up

  void read(const StepSource& source);
  void act(Run& run) const override;
  bool write(TranscriptWriter& writer) const override;
};

}  // namespace s7200::tools
