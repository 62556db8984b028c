// What is wrong with a program after a run.
#pragma once

#include <vector>

#include "tools/fuzzing/fuzz.hpp"
#include "tools/trials/trial_bench.hpp"

namespace s7200::tools {

class Oracle {
 public:
  Oracle(const Inspection& inspection, const FuzzSettings& settings);

  /// What the bench shows that was not there in `before`, of which `op` of a write is not known yet.
  std::vector<FuzzFinding> look(const TrialBench& bench, const State& before) const;

  /// Lets rules be looked at after each scan; a broken one ends the run.
  void watch_rules(TrialBench& bench);

  /// Sends a request that was answered before; whether no answer comes. The bench has moved on.
  bool is_silent(TrialBench& bench, const std::vector<std::uint8_t>& request) const;

  /// The steps of a scenario that fail because of a finding, with the bench as it is then and as it was at first.
  std::string end_of_scenario(const FuzzFinding& finding, const TrialBench& bench, const State& first) const;

 private:
  struct Forbidden {
    std::uint32_t from = 0, to = 0;  ///< bytes of the image
  };
  std::string rule_check(const FuzzFinding& finding, const TrialBench& bench, const State& first) const;

  const Program& program_;
  const FuzzSettings& settings_;
  std::vector<Forbidden> forbidden_;
  mutable std::optional<std::size_t> broken_;  // rule, in this run
};

}  // namespace s7200::tools
