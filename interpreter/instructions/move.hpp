// Bodies: move, block move, fill, swap (facts 6.5).
#pragma once

#include "interpreter/cpu/cpu.hpp"

namespace s7200::bodies {

template <class Value>
void move(Cpu& cpu, const Op& op) {
  cpu.put(op[1], cpu.get<Value>(op[0]));
}

/// BMB, BMW, BMD.
/// Not documented, modelled so:
/// - The destination of a block move gets what was in the source before, even where the two overlap. [Vectors.BMB]
/// - N = 0 in a variable is error 0092, for FILL and for S, R, SI and RI too. [Vectors.BMB, Vectors.FILL, Vectors.S]
template <class Value>
void move_block(Cpu& cpu, const Op& op) {
  const std::uint32_t count = cpu.get<std::uint8_t>(op[2]);
  const std::uint32_t bytes = count * sizeof(Value);
  if (count == 0) return cpu.run_error(RunError::Count);
  if (!cpu.in_area(op[0].at, bytes) || !cpu.in_area(op[1].at, bytes)) return cpu.run_error(RunError::OperandRange);
  cpu.spend(op, count);
  std::memmove(&cpu.s.image[op[1].at], &cpu.s.image[op[0].at], bytes);
}

inline void fill(Cpu& cpu, const Op& op) {
  const std::uint32_t count = cpu.get<std::uint8_t>(op[2]);
  if (count == 0) return cpu.run_error(RunError::Count);
  if (!cpu.in_area(op[1].at, count * 2)) return cpu.run_error(RunError::OperandRange);
  cpu.spend(op, count);
  const auto value = cpu.get<std::uint16_t>(op[0]);
  for (std::uint32_t i = 0; i < count; ++i) store16(&cpu.s.image[op[1].at + 2 * i], value);
}

inline void swap_bytes(Cpu& cpu, const Op& op) {
  const auto value = cpu.get<std::uint16_t>(op[0]);
  cpu.put(op[0], static_cast<std::uint16_t>(value << 8 | value >> 8));
}

}  // namespace s7200::bodies
