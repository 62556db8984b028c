// Bodies: contacts, coils, the logic stack, edges, set and reset (facts 6.2).
#pragma once

#include "interpreter/cpu/core.hpp"
#include "interpreter/cpu/units/points.hpp"
#include "interpreter/cpu/units/timers.hpp"
#include "interpreter/instructions/linked.hpp"

namespace s7200::bodies {

template <Join join>
inline void combine(LogicStack& stack, bool value) {
  if constexpr (join == Join::Load)
    stack.push(value);
  else if constexpr (join == Join::And)
    stack.set_top(stack.top() & value);
  else
    stack.set_top(stack.top() | value);
}

/// The feed of a contact: outside SCR segments the rail always has power; inside one the segment's rail has the power that
/// LSCR gave it. A contact in series (A) is fed by the top of the stack instead.
enum class Rail { Always, Segment };

template <Join join, Rail rail>
inline bool fed(const Core& core) {
  return rail == Rail::Always || join == Join::And || core.s.rail;
}

/// LD, A, O and their negated and immediate forms: an immediate form reads the input point itself (decided at load).
template <Join join, bool negated, Rail rail = Rail::Always>
void contact(Core& core, const Op& op) {
  combine<join>(core.s.stack, fed<join, rail>(core) && core.bit(op[0]) != negated);
}

template <Join join, bool negated>
inline constexpr Bodies kContact{
    contact<join, negated>, contact<join, negated, Rail::Segment>, nullptr, {ChainPart::Kind::Contact, join, negated}};

inline void invert_top(Core& core, const Op&) { core.s.stack.set_top(!core.s.stack.top()); }

/// ALD and OLD.
template <Join join>
void combine_loads(Core& core, const Op&) {
  const bool top = core.s.stack.top();
  core.s.stack.pop();
  combine<join>(core.s.stack, top);
}

inline void push_copy(Core& core, const Op&) { core.s.stack.push(core.s.stack.top()); }
/// LDS n
inline void push_level(Core& core, const Op& op) { core.s.stack.push(core.s.stack.level(static_cast<int>(op[0].at))); }

/// AENO. Every box sets ENO: 0 after a run-time error, or if a flag of SM1 says that it has failed
/// (facts 10.7).
/// Not documented, modelled so:
/// - ENO is 1 at the start of a scan and of a routine, and after a return to the caller; an interrupt leaves it alone.
///   [Eno.IsOneAtTheStartOfAScanAndOfARoutineAndAfterTheReturn, Eno.AnInterruptRoutineLeavesItAlone]
/// - The flags that make ENO 0 are SM1.1 and SM1.3 to SM1.7, of boxes that set them for a failure: not SM1.1 of shifts.
///   [Eno.FlagsThatSayFailureMakeItZero]
/// - A box without power flow makes ENO 0. [FastLoop.ABoxWithoutPowerFlowLeavesNoEno]
/// - S, R, SI, RI, ENI and DISI are coils: they leave ENO alone. [Vectors.AENO]
inline void and_eno(Core& core, const Op&) { core.s.stack.set_top(core.s.stack.top() && core.s.eno); }

inline void read_second(Core& core, const Op&) { core.s.stack.set_top(core.s.stack.level(1)); }
inline void pop_stack(Core& core, const Op&) { core.s.stack.pop(); }

/// EU and ED. Each has its own memory bit (operand 2, added at load): the top of the stack at its last execution. In the
/// first scan there is nothing to compare with, so there is no edge (facts 9.1; S7-200 SMART manual A5E03822230-AC, 157).
///
/// Not documented, modelled so:
/// - The first execution of EU or ED finds no edge, even in a later scan. [Choices.TheFirstExecutionOfEuAndEdFindsNoEdge]
/// - An EU or ED that is jumped over keeps its memory. [Choices.AnEdgeInstructionThatIsJumpedOverKeepsItsMemory]
template <bool rising>
void edge(Core& core, const Op& op) {
  const bool before = core.bit(op[2]), now = core.s.stack.top();
  core.put_bit(op[2].at, op[2].bit, now);
  core.s.stack.set_top(rising ? !before && now : before && !now);
}

inline void coil(Core& core, const Op& op) { core.put_bit(op[0].at, op[0].bit, core.s.stack.top()); }
inline constexpr Bodies kCoilBody{coil, nullptr, nullptr, {.kind = ChainPart::Kind::Coil}};

/// =I writes the image register and the output point (operand 2, added at load).
inline void immediate_coil(Core& core, const Op& op) {
  core.put_bit(op[0].at, op[0].bit, core.s.stack.top());
  points::write_output(core, op[2].at - image::kOutputs, op[2].bit, core.s.stack.top());
}

inline void put_bits(Core& core, const Operand& first, std::uint32_t count, bool value) {
  for (std::uint32_t i = 0, place = first.bit; i < count; ++i, ++place)
    core.put_bit(first.at + place / 8, static_cast<std::uint8_t>(place % 8), value);
}

/// S, R and SI, RI: `count` bits from operand 0. SI and RI also write the output points (operand 2, added at load).
template <bool value, bool immediate>
void set_bits(Core& core, const Op& op) {
  const std::uint32_t count = core.get<std::uint8_t>(op[1]);
  if (count == 0) return core.run_error(RunError::Count);
  if (count > op.target) return core.run_error(RunError::OperandRange);
  core.spend(op, count);
  put_bits(core, op[0], count, value);
  if constexpr (immediate)
    for (std::uint32_t i = 0, place = op[2].bit; i < count; ++i, ++place)
      points::write_output(core, op[2].at - image::kOutputs + place / 8, static_cast<std::uint8_t>(place % 8), value);
  if constexpr (!value) timers::clear_current_values(core, op[0], count);
}

inline void no_operation(Core&, const Op&) {}

}  // namespace s7200::bodies
