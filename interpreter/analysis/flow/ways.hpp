// What has to be so that an instruction is executed, with power flow or without: the contacts of its rung, and what leads to
// it: the S bit of its segment, jumps and conditional ends in front of it, the calls of its routine.
//
// A way is a set of conditions that together suffice. Of all ways those are kept that change the fewest of the conditions as
// they are at present. FOR is not among them: a loop may run no time.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "interpreter/analysis/effects/facts.hpp"
#include "interpreter/analysis/flow/exclusions.hpp"
#include "interpreter/program/ladder/network_logic.hpp"

namespace s7200 {

/// Sorted, each op once.
using Conditions = std::vector<Condition>;

/// What the logic stack holds in front of an instruction.
struct RungLogic {
  NetworkLogic logic;
  std::vector<std::size_t> inputs;  ///< gates: the levels that it uses, the top first; none if it uses none
};

class Ways {
 public:
  static constexpr std::size_t kMost = 64;  ///< that are kept

  /// How things are at present.
  struct Present {
    std::function<bool(std::uint32_t op)> holds;     ///< whether a condition with `on` is fulfilled
    std::function<bool(std::uint32_t op)> executed;  ///< whether it is known that an op is executed: nothing keeps it away
    /// From where on the logic of an op is read; null: from the beginning of its network.
    std::function<std::uint32_t(std::uint32_t op)> begins = {};
  };

  /// `facts` must live as long as this.
  Ways(const Facts& facts, Present present);

  /// That an op is executed and has power flow, or has none. Empty: no way leads there.
  std::vector<Conditions> to(std::uint32_t op, bool power) const;

  /// That a level of the logic stack is so in front of an op, whatever leads there: 0 is the top. In a segment none has
  /// power while its S bit is off.
  std::vector<Conditions> input(std::uint32_t op, std::size_t level, bool on) const;

  std::vector<Conditions> both(const std::vector<Conditions>& first, const std::vector<Conditions>& second) const;
  std::vector<Conditions> either(std::vector<Conditions> first, const std::vector<Conditions>& second) const;

  /// The conditions of a way that are not fulfilled at present.
  Conditions changes(const Conditions& way) const;

  /// Those of all ways, the fewest first; none that has another one in it.
  std::vector<Conditions> fewest_changes(const std::vector<Conditions>& ways) const;

  /// Why there was no way since this was asked last: two conditions that exclude each other. Nothing if there is another
  /// reason, or if there were more ways than are kept.
  std::optional<Exclusion> take_exclusion() const;

  /// The rung of an op.
  const RungLogic& rung_of(std::uint32_t op) const;
  std::uint32_t op_of(const NetworkLogic::Contact& contact) const;

  const Facts& facts() const { return facts_; }

 private:
  RungLogic read_rung(std::uint32_t first, std::uint32_t op) const;
  std::vector<Conditions> of_gate(const NetworkLogic& logic, std::size_t gate, bool on) const;
  std::vector<Conditions> reached(std::uint32_t op) const;
  std::vector<Conditions> routine_runs(std::uint32_t routine) const;
  void prune(std::vector<Conditions>& ways) const;

  std::optional<Conditions> merged(const Conditions& first, const Conditions& second) const;

  const Facts& facts_;
  Present present_;
  Exclusions exclusions_;
  mutable std::optional<Exclusion> exclusion_{};
  mutable bool left_some_out_ = false;
  mutable std::map<std::uint32_t, RungLogic> rungs_{};
  mutable std::vector<std::uint32_t> open_{};  // routines whose calls are being followed
};

}  // namespace s7200
