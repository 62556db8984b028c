// Which memory an operand is, as far as its text says: whether writing one may change another.
#pragma once

#include <optional>
#include <string>

#include "interpreter/stl/ast.hpp"

namespace s7200 {

/// Bits of an area, or numbers of timers, counters and accumulators: from `from` until before `to`.
struct OperandMemory {
  std::string area;
  std::uint64_t from = 0, to = 0;

  bool overlaps(const OperandMemory& other) const { return area == other.area && from < other.to && other.from < to; }
};

/// The memory of a direct address; nothing for a constant, a pointer or a symbol.
std::optional<OperandMemory> memory_of(const stl::Operand& operand);

/// Whether writing `written` changes what `read` is: they overlap, or `read` goes through a pointer that is overwritten.
bool changes(const stl::Operand& written, const stl::Operand& read);

/// Whether the write may change what the read reads: the memory is the same, or a pointer is involved that may point there.
bool may_change(const stl::Operand& written, const stl::Operand& read);

}  // namespace s7200
