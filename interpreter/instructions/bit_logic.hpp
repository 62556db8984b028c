// Bodies: contacts, coils, the logic stack, edges, set and reset (facts 6.2).
#pragma once

#include "interpreter/cpu/cpu.hpp"

namespace s7200::bodies {

/// How a contact joins what is on the logic stack.
enum class Join { Load, And, Or };

template <Join join>
inline void combine(LogicStack& stack, bool value) {
  if constexpr (join == Join::Load)
    stack.push(value);
  else if constexpr (join == Join::And)
    stack.set_top(stack.top() & value);
  else
    stack.set_top(stack.top() | value);
}

/// What feeds a contact: outside SCR segments the rail always has power; inside one it is the segment's, as LSCR left it.
/// A contact in series (A) is fed by the top of the stack instead.
enum class Rail { Always, Segment };

template <Join join, Rail rail>
inline bool fed(const Cpu& cpu) {
  return rail == Rail::Always || join == Join::And || cpu.s.rail;
}

/// LD, A, O and their negated and immediate forms: an immediate one reads the input point itself (decided at load).
template <Join join, bool negated, Rail rail = Rail::Always>
void contact(Cpu& cpu, const Op& op) {
  combine<join>(cpu.s.stack, fed<join, rail>(cpu) && cpu.bit(op[0]) != negated);
}

inline void invert_top(Cpu& cpu, const Op&) { cpu.s.stack.set_top(!cpu.s.stack.top()); }

/// ALD and OLD.
template <Join join>
void combine_loads(Cpu& cpu, const Op&) {
  const bool top = cpu.s.stack.top();
  cpu.s.stack.pop();
  combine<join>(cpu.s.stack, top);
}

inline void push_copy(Cpu& cpu, const Op&) { cpu.s.stack.push(cpu.s.stack.top()); }
inline void read_second(Cpu& cpu, const Op&) { cpu.s.stack.set_top(cpu.s.stack.level(1)); }
inline void pop_stack(Cpu& cpu, const Op&) { cpu.s.stack.pop(); }

/// EU and ED. Each has a memory bit of its own (operand 2, given at load): the top of the stack at its last execution. In
/// the first scan there is nothing to compare with, hence no edge (facts 9.1; S7-200 SMART manual A5E03822230-AC, 157).
///
/// Not documented, modelled so:
/// - The first execution of EU or ED finds no edge in a later scan either. [Choices.TheFirstExecutionOfEuAndEdFindsNoEdge]
/// - An EU or ED that is jumped over keeps its memory. [Choices.AnEdgeInstructionThatIsJumpedOverKeepsItsMemory]
template <bool rising>
void edge(Cpu& cpu, const Op& op) {
  const bool before = cpu.bit(op[2]), now = cpu.s.stack.top();
  cpu.put_bit(op[2].at, op[2].bit, now);
  cpu.s.stack.set_top(rising ? !before && now : before && !now);
}

inline void coil(Cpu& cpu, const Op& op) { cpu.put_bit(op[0].at, op[0].bit, cpu.s.stack.top()); }

/// =I writes the image register and the output point (operand 2, given at load).
inline void immediate_coil(Cpu& cpu, const Op& op) {
  cpu.put_bit(op[0].at, op[0].bit, cpu.s.stack.top());
  cpu.write_output_point(op[2].at - image::kOutputs, op[2].bit, cpu.s.stack.top());
}

inline void put_bits(Cpu& cpu, const Operand& first, std::uint32_t count, bool value) {
  for (std::uint32_t i = 0, place = first.bit; i < count; ++i, ++place)
    cpu.put_bit(first.at + place / 8, static_cast<std::uint8_t>(place % 8), value);
}

/// S, R and SI, RI: `count` bits from operand 0 on. Immediate: the output points (operand 2, given at load) too.
template <bool value, bool immediate>
void set_bits(Cpu& cpu, const Op& op) {
  const std::uint32_t count = cpu.get<std::uint8_t>(op[1]);
  if (count == 0) return cpu.run_error(RunError::Count);
  if (!cpu.bits_in_area(op[0], count)) return cpu.run_error(RunError::OperandRange);
  cpu.spend(op, count);
  put_bits(cpu, op[0], count, value);
  if constexpr (immediate)
    for (std::uint32_t i = 0, place = op[2].bit; i < count; ++i, ++place)
      cpu.write_output_point(op[2].at - image::kOutputs + place / 8, static_cast<std::uint8_t>(place % 8), value);
  if constexpr (!value) cpu.clear_current_values(op[0], count);
}

inline void no_operation(Cpu&, const Op&) {}

}  // namespace s7200::bodies
