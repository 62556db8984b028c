// Boxes whose result is known from their operands, in numbers: moves, conversions, INC and DEC, arithmetic with integers,
// masks, shifts.
//
// An address that is counted on stays in its area: for another it would have to go through 16 million addresses that point
// nowhere.
#pragma once

#include <cstdint>
#include <optional>

#include "interpreter/analysis/effects/value_set.hpp"
#include "interpreter/program/program.hpp"

namespace s7200 {

constexpr std::int64_t kAreaSize = 0x100'0000;  ///< addresses that a pointer's top byte leaves

/// No area has so many bytes: nothing that counts comes through here.
constexpr bool is_limit_of_area(std::int64_t value) { return (value & (kAreaSize - 1)) == kAreaSize / 2; }

/// Where a box puts its result, and the operand that it only reads.
struct ValueBox {
  using Computes = ValueSet (*)(const ValueSet& in, const ValueSet& old);

  Computes result = nullptr;
  std::uint8_t to = 0;
  std::optional<std::uint8_t> from;

  bool carries() const;  ///< its result is its input: moves and conversions
};

/// Nothing of an instruction that is no such box.
std::optional<ValueBox> value_box_of(const Instruction& instruction);

/// The value of an operand that is a constant.
std::optional<std::int64_t> constant_value(const Program& program, const Operand& operand, Width width);

/// Whether an op adds a constant to its operand, or subtracts one, that is less than an area's worth of addresses: INCD, +D.
/// The constant is what is added.
std::optional<std::int64_t> step_of(const Program& program, const Op& op);

/// What the box `op` makes of its operands; `number` is the op's, for the cause of a result that has no end.
ValueSet result_of(const Program& program, std::uint32_t number, const ValueBox& box, const ValueSet& in,
                   const ValueSet& old);

/// Counted on by some number of `by`.
ValueSet counted_on(const ValueSet& old, const ValueRange& by);

/// `before` with another number below `size` in its lower bits.
ValueSet with_lower_part(const ValueSet& before, std::int64_t size, const ValueSet& part);

}  // namespace s7200
