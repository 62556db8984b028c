// The bytes, words and double words whose values are followed through a program (reaching_values.hpp): its pointers, the
// ends of its FOR loops, what these are made of, and who writes them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "interpreter/analysis/effects/pointers.hpp"
#include "interpreter/analysis/effects/value_set.hpp"
#include "interpreter/analysis/flow/calls.hpp"
#include "interpreter/analysis/flow/flow.hpp"

namespace s7200 {

/// Memory that neither the CPU nor the field changes by itself.
bool is_quiet(std::uint32_t at, std::uint32_t bytes);
bool is_accumulator(std::uint32_t at);
bool is_local_place(std::uint32_t at);

/// Whether an access is one of the op's operands, and not flags, nor what CALL and RET do besides.
bool is_of_operand(const MemoryAccess& access);

/// CALL clears the local memory of the subroutine, which is another one.
bool is_local_clearing(const MemoryAccess& access);

/// A byte, word or double word whose values are followed.
struct FollowedCell {
  std::uint32_t at = 0;
  Width width = Width::Double;
  bool kept = false;          ///< from one scan to the next
  bool set_by_name = false;   ///< some instruction writes it, and not through a pointer
  bool by_interrupt = false;  ///< an interrupt routine writes it
  bool by_system = false;     ///< the system does, at any time
  std::set<std::int64_t> compared{};

  Bits bits() const { return {at * 8u, bytes_of(width) * 8u}; }
};

/// Ranges that grow go on as far as the program compares, or else as far as pointers to the area may lead. `all`: so do
/// those that come to others of their area.
ValueSet widened(const FollowedCell& cell, const ValueSet& before, const ValueSet& now, bool all);

class FollowedCells {
 public:
  FollowedCells(const Program& program, const ControlFlow& flow, const std::vector<std::vector<MemoryAccess>>& effects,
                const Pointers& pointers, const Calls& calls);

  bool empty() const { return cells_.empty(); }
  std::size_t size() const { return cells_.size(); }
  const FollowedCell& operator[](std::size_t cell) const { return cells_[cell]; }
  auto begin() const { return cells_.begin(); }
  auto end() const { return cells_.end(); }

  /// The number of the cell at a place; nothing if it is not followed.
  std::optional<std::size_t> at(std::uint32_t at, Width width) const;
  std::optional<std::size_t> of(const Operand& operand, Width width) const;

  /// Whether a routine writes a cell, itself or in what it calls.
  bool written_in(std::size_t routine, std::size_t cell) const { return writes_[routine][cell]; }

 private:
  void find();
  void note_counting(const Op& op);
  void note_comparison(const Op& op);
  void want(const Operand& operand, Width width);
  void want(std::uint32_t at, Width width);
  void want_sources();
  bool is_followed(std::uint32_t at, Width width) const;
  void find_writers(const std::vector<std::vector<MemoryAccess>>& effects, const Calls& calls);
  void add_writes_of_callees();

  const Program& program_;
  const ControlFlow& flow_;
  const Pointers& pointers_;
  std::vector<FollowedCell> cells_{};
  std::map<std::pair<std::uint32_t, Width>, std::size_t> number_{};  // of a cell, by place
  std::vector<std::vector<bool>> writes_{};                          // by routine and cell
};

}  // namespace s7200
