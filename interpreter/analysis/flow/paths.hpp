// Which ops are executed whenever others are: the paths through the routines of a program.
#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "interpreter/analysis/flow/flow.hpp"

namespace s7200 {

/// Ops in a row, from `from` until before `to`.
struct Stretch {
  std::uint32_t from = 0, to = 0;
};

class Paths {
 public:
  /// `program` must live as long as this.
  Paths(const Program& program, ControlFlow flow);

  /// The routine of an op, in ControlFlow::routines.
  std::uint32_t routine(std::uint32_t op) const { return flow_.nodes[op].routine; }

  /// Whether both belong to the same routine and it never ends between the first and the second.
  bool leads_to(std::uint32_t first, std::uint32_t second) const {
    return routine(first) == routine(second) && first != second && necessary(second, first);
  }

  /// The ops that may be executed between the first and the second.
  std::vector<Stretch> between(std::uint32_t first, std::uint32_t second) const;

  /// The interrupt routines.
  std::vector<Stretch> interrupts() const;

  /// Whether every scan executes it.
  bool in_every_scan(std::uint32_t op);

 private:
  bool is_block_begin(std::uint32_t op) const { return op == 0 || block_[op - 1] != block_[op]; }
  bool necessary(std::uint32_t other, std::uint32_t op) const;
  void find_blocks();
  void find_necessary();
  std::vector<std::uint32_t> from_the_end() const;
  void number_tree(const std::vector<std::uint32_t>& order, const std::vector<std::uint32_t>& parent);
  bool routine_in_every_scan(std::uint32_t routine);

  const Program& program_;
  ControlFlow flow_;
  std::uint32_t count_;
  std::vector<std::uint32_t> block_, block_end_;               // of an op: its basic block; of a block: its end
  std::vector<bool> ends_;                                     // whether some way leads from an op to the end of its routine
  std::vector<std::pair<std::uint32_t, std::uint32_t>> span_;  // of an op's numbers in the tree of post-dominators
  std::map<std::uint32_t, bool> called_{};                     // by routine: whether every scan calls it
};

}  // namespace s7200
