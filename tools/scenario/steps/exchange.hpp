// A request and its answer: what the steps that send have in common.
#pragma once

#include "tools/scenario/steps/expected/reception.hpp"

namespace s7200::tools {

struct ExchangeStep final : Reception {
  serial::Frame request{};      ///< all of it, its CRC included
  std::optional<Time> at{};     ///< when the request begins, since power-up; on other slaves since the first step
  std::optional<Span> pause{};  ///< between the exchange before and this one; the scenario's if not given
  Span gap{};                   ///< between the characters of the request

  /// What stands beside every request: when it is sent, and what is expected.
  void read_beside(const StepSource& source);

  void act(Run& run) const override;
  bool write(TranscriptWriter& writer) const override;

 private:
  bool wait_for_begin(Run& run) const;
};

/// `01 03 00 0a`; empty after a complaint.
serial::Frame hex_frame(ValueReader& values, const YamlNode& node);

/// Complains at what is expected of the answer.
void wrong_expectation(const StepSource& source, std::string message, std::string hint = {});

}  // namespace s7200::tools
