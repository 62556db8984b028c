// Bodies: move, block move, fill, swap (facts 6.5).
#pragma once

#include "interpreter/cpu/core.hpp"

namespace s7200::bodies {

template <class Value>
void move(Core& core, const Op& op) {
  core.put(op[1], core.get<Value>(op[0]));
}

/// BMB, BMW, BMD.
/// Not documented, modelled so:
/// - The destination of a block move gets what was in the source before the move, even if the two overlap. [Vectors.BMB]
/// - N = 0 in a variable is error 0092, also for FILL and for S, R, SI and RI. [Vectors.BMB, Vectors.FILL, Vectors.S]
template <class Value>
void move_block(Core& core, const Op& op) {
  const std::uint32_t count = core.get<std::uint8_t>(op[2]);
  const std::uint32_t bytes = count * sizeof(Value);
  if (count == 0) return core.run_error(RunError::Count);
  if (!core.in_area(op[0].at, bytes) || !core.in_area(op[1].at, bytes)) return core.run_error(RunError::OperandRange);
  core.spend(op, count);
  std::memmove(&core.s.image[op[1].at], &core.s.image[op[0].at], bytes);
}

inline void fill(Core& core, const Op& op) {
  const std::uint32_t count = core.get<std::uint8_t>(op[2]);
  if (count == 0) return core.run_error(RunError::Count);
  if (!core.in_area(op[1].at, count * 2)) return core.run_error(RunError::OperandRange);
  core.spend(op, count);
  const auto value = core.get<std::uint16_t>(op[0]);
  for (std::uint32_t i = 0; i < count; ++i) store16(&core.s.image[op[1].at + 2 * i], value);
}

inline void swap_bytes(Core& core, const Op& op) {
  const auto value = core.get<std::uint16_t>(op[0]);
  core.put(op[0], static_cast<std::uint16_t>(value << 8 | value >> 8));
}

}  // namespace s7200::bodies
