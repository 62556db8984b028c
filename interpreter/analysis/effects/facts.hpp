// What warnings and views ask of a program, worked out once.
#pragma once

#include <optional>
#include <vector>

#include "interpreter/analysis/effects/effects.hpp"
#include "interpreter/analysis/flow/flow.hpp"

namespace s7200 {

struct Facts {
  const Program& program;
  ControlFlow flow;
  Pointers pointers;
  std::vector<std::vector<MemoryAccess>> effects;  ///< by op: effects_of(), and of RCV and PLS no more than the program allows them
  /// By op: the number of its network. That of its NETWORK line; in a routine without numbered lines, counted from 1; 0 in
  /// front of the first of them.
  std::vector<std::uint32_t> networks;
};

/// `program` must live as long as what is returned. If `waiter` asks to end, less is known of pointers.
Facts facts_of(const Program& program, const Waiter& waiter = {});

/// The same as if nothing were known of pointers. Where they lead takes longer to work out than many a run.
Facts facts_without_pointers(const Program& program);

/// The constants that instructions move to memory at `at`, a byte, a word or a double word; nothing if one of those that
/// write there does anything else.
std::optional<std::vector<std::int64_t>> constants_written(const Facts& facts, std::uint32_t at, Width width);

}  // namespace s7200
