// The part of a program that someone asks about, in words: addresses, symbols, routines, networks.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "interpreter/analysis/effects/facts.hpp"
#include "interpreter/base/result.hpp"

namespace s7200 {

struct Selection {
  struct Memory {
    std::string text;  ///< as it was asked for
    Bits bits;         ///< as programs name it (memory_names.hpp)
  };
  /// Ops from `first` on, until before `end`.
  struct Ops {
    std::string text;
    std::uint32_t first = 0, end = 0;
  };

  std::vector<Memory> memory;
  std::vector<Ops> ops;

  bool everything() const { return memory.empty() && ops.empty(); }
  bool has(const Bits& bits) const;
  bool has_op(std::uint32_t op) const;
  /// Whether it names no memory, or some of this.
  bool wants_memory(const std::vector<Bits>& bits) const;
  /// Whether it names no routine and no network, or one with one of these ops.
  bool wants_ops(const std::vector<std::uint32_t>& which) const;
};

/// Words such as `VW10`, `VB0:16`, `Speed`, `MAIN`, `SBR_3`, `INT0`, `SBR_3:2` for a network of it, or the name of a block.
/// Trouble with what is near, if a word is none of these.
Result<Selection> parse_selection(std::span<const std::string> words, const Facts& facts);

/// `MAIN`, `SBR_3`, `INT_0`: the name that Micro/WIN gives a routine.
std::string routine_text(const Routine& routine);

/// The routine's block in an export; null in a listing.
const stl::Block* block_of(const Program& program, const Routine& routine);

}  // namespace s7200
