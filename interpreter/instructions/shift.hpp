// The bodies of shifts and rotates (facts 6.8).
#pragma once

#include <algorithm>
#include <bit>

#include "interpreter/cpu/core.hpp"

namespace s7200::bodies {

/// SM1.0: result zero. SM1.1: last bit shifted or rotated out.
inline constexpr std::uint8_t kShiftFlags = kZero | kOverflow;

inline void set_shift_flags(Core& core, bool zero, bool last_out) {
  core.set_flags(kShiftFlags, static_cast<std::uint8_t>((zero ? kZero : 0) | (last_out ? kOverflow : 0)));
}

/// SLB, SRB, SLW, SRW, SLD, SRD: a count above the width counts as the width.
/// Not documented, modelled so: a shift by 0 sets SM1.0, as a rotate by 0 does, and leaves SM1.1 as it was. [Vectors.SLW]
template <class Value, bool left>
void shift(Core& core, const Op& op) {
  constexpr std::uint32_t kBits = 8 * sizeof(Value);
  const std::uint32_t count = std::min<std::uint32_t>(core.get<std::uint8_t>(op[1]), kBits);
  const std::uint64_t value = core.get<Value>(op[0]);
  if (count == 0) return core.set_flags(kZero, value == 0 ? kZero : 0);
  core.spend(op, count);
  const auto result = static_cast<Value>(left ? value << count : value >> count);
  const bool last_out = left ? (value >> (kBits - count)) & 1 : (value >> (count - 1)) & 1;
  core.put(op[0], result);
  set_shift_flags(core, result == 0, last_out);
}

/// RLB, RRB, RLW, RRW, RLD, RRD: the count is taken modulo the width. If that is 0, nothing is rotated and SM1.1 stays as it
/// was; SM1.0 always says whether the value is zero (S7-200 manual C233-01, 9-119 to 9-121).
template <class Value, bool left>
void rotate(Core& core, const Op& op) {
  constexpr std::uint32_t kBits = 8 * sizeof(Value);
  const int count = static_cast<int>(core.get<std::uint8_t>(op[1]) % kBits);
  const auto value = core.get<Value>(op[0]);
  if (count == 0) return core.set_flags(kZero, value == 0 ? kZero : 0);
  core.spend(op, count);
  const Value result = left ? std::rotl(value, count) : std::rotr(value, count);
  core.put(op[0], result);
  set_shift_flags(core, result == 0, left ? result & 1 : (result >> (kBits - 1)) & 1);
}

/// SHRB DATA, S_BIT, N: |N| bits from S_BIT move by one. N > 0: DATA enters at S_BIT; N < 0: at the far end. The bit shifted
/// out goes to SM1.1. N = 0 is error 0092 (S7-200 SMART manual A5E03822230-AC, 318).
inline void shift_register(Core& core, const Op& op) {
  const std::int32_t n = core.get<std::int8_t>(op[2]);
  const auto length = static_cast<std::uint32_t>(n < 0 ? -n : n);
  if (length == 0 || length > 64) return core.run_error(RunError::Count);
  if (length > op.target) return core.run_error(RunError::OperandRange);
  core.spend(op, length);
  const bool data = core.bit(op[0]);
  const auto place = [&](std::uint32_t i) {
    return Operand{.at = op[1].at + (op[1].bit + i) / 8, .bit = static_cast<std::uint8_t>((op[1].bit + i) % 8)};
  };
  const auto move = [&](std::uint32_t to, bool value) { core.put_bit(place(to).at, place(to).bit, value); };
  const bool out = core.bit(place(n > 0 ? length - 1 : 0));
  if (n > 0) {
    for (std::uint32_t i = length - 1; i > 0; --i) move(i, core.bit(place(i - 1)));
    move(0, data);
  } else {
    for (std::uint32_t i = 0; i + 1 < length; ++i) move(i, core.bit(place(i + 1)));
    move(length - 1, data);
  }
  core.set_flags(kOverflow, out ? kOverflow : 0);
}

}  // namespace s7200::bodies
