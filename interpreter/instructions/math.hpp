// Bodies: integer arithmetic, increment and decrement, logic (facts 6.6, 6.7).
//
// Overflow sets SM1.1. The CPU model says what +I, -I, +D, -D and DIV then leave in OUT. A CPU 22x keeps its operands; SM1.0
// and SM1.2 are not valid (S7-200 manual from 2004 on, 140) and are 0 here. MUL cannot overflow.
//
// Not documented, modelled so:
// - A CPU 21x stores the wrapped result of an overflow; SM1.0 and SM1.2 show what was stored. [Vectors.ADD_I]
// - INCB, INCW, INCD and DECB, DECW, DECD wrap on every CPU, and SM1.0 and SM1.2 show what was stored.
//   [Vectors.INCW, Overflow.IncrementAndDecrementWrapOnEveryCpu]
// - SM1.0 and SM1.2 after DIV show only the quotient. [Vectors.DIV]
// - -32768 / -1 is an overflow of DIV: on a CPU 21x the wrapped quotient is 16#8000, the remainder 0; on a CPU 22x both
//   words of OUT stay as they were. [Vectors.DIV, Overflow.ACpuThatKeepsItsOperandsSetsSM11Only]
// - *I, *D, /I and /D reset SM1.3 if they do not divide by zero; +I, -I, +D and -D leave it as it was.
//   [Overflow.MultiplicationsAndDivisionsResetSM13AndSumsLeaveIt]
#pragma once

#include <limits>
#include <type_traits>

#include "interpreter/cpu/core.hpp"

namespace s7200::bodies {

template <class Signed>
std::uint8_t sign_flags(Signed value) {
  return static_cast<std::uint8_t>((value == 0 ? kZero : 0) | (value < 0 ? kNegative : 0));
}

// The SM1 bits that arithmetic sets and resets.
inline constexpr std::uint8_t kArithmetic = kZero | kOverflow | kNegative;
inline constexpr std::uint8_t kUnsignedArithmetic = kZero | kOverflow;
inline constexpr std::uint8_t kMultiplyDivide = kArithmetic | kDivisionByZero;

template <class Signed>
void store_wrapped(Core& core, const Operand& out, Signed value, bool overflow) {
  core.put(out, value);
  core.set_flags(kArithmetic, static_cast<std::uint8_t>(sign_flags(value) | (overflow ? kOverflow : 0)));
}

inline bool keeps_operands(const Core& core) { return core.program().model->integer_overflow == IntegerOverflow::Keep; }

template <class Signed>
void store_result(Core& core, const Operand& out, Signed value, bool overflow) {
  if (overflow && keeps_operands(core)) return core.set_flags(kArithmetic, kOverflow);
  store_wrapped(core, out, value, overflow);
}

/// +I, +D
template <class Signed>
void add(Core& core, const Op& op) {
  Signed result;
  const bool overflow = __builtin_add_overflow(core.get<Signed>(op[1]), core.get<Signed>(op[0]), &result);
  store_result(core, op[1], result, overflow);
}

/// -I, -D
template <class Signed>
void subtract(Core& core, const Op& op) {
  Signed result;
  const bool overflow = __builtin_sub_overflow(core.get<Signed>(op[1]), core.get<Signed>(op[0]), &result);
  store_result(core, op[1], result, overflow);
}

/// INCW, INCD, DECW, DECD
template <class Signed, int step>
void increment(Core& core, const Op& op) {
  Signed result;
  const bool overflow = __builtin_add_overflow(core.get<Signed>(op[0]), Signed{step}, &result);
  store_wrapped(core, op[0], result, overflow);
}

/// INCB, DECB: unsigned (facts 9.1).
template <int step>
void increment_byte(Core& core, const Op& op) {
  std::uint8_t result;
  const bool overflow = __builtin_add_overflow(core.get<std::uint8_t>(op[0]), step, &result);
  core.put(op[0], result);
  core.set_flags(kUnsignedArithmetic, static_cast<std::uint8_t>((result == 0 ? kZero : 0) | (overflow ? kOverflow : 0)));
}

/// The low word of a double word operand.
inline Operand low_word(const Operand& operand) {
  Operand low = operand;
  low.at += 2;
  return low;
}

/// MUL: 16 × 16 = 32 bits; the second factor is the low word of OUT.
inline void multiply(Core& core, const Op& op) {
  const std::int32_t product = std::int32_t{core.get<std::int16_t>(op[0])} * core.get<std::int16_t>(low_word(op[1]));
  core.put(op[1], product);
  core.set_flags(kMultiplyDivide, sign_flags(product));
}

/// DIV: dividend in the low word of OUT; quotient to the low word, remainder to the high word. Division by zero sets SM1.3
/// and changes nothing else (S7-200 manual C233-01, 9-76).
inline void divide(Core& core, const Op& op) {
  const std::int32_t divisor = core.get<std::int16_t>(op[0]);
  if (divisor == 0) return core.set_flags(kDivisionByZero, kDivisionByZero);
  const std::int32_t dividend = core.get<std::int16_t>(low_word(op[1]));
  const auto quotient = static_cast<std::int16_t>(dividend / divisor);
  const bool overflow = dividend / divisor != quotient;
  core.set_flags(kDivisionByZero, 0);
  if (!overflow || !keeps_operands(core)) core.put(op[1], static_cast<std::int16_t>(dividend % divisor));
  store_result(core, low_word(op[1]), quotient, overflow);
}

/// *I, *D: the product has the width of its factors; if it does not fit, OUT stays and the other flags are 0 (facts 6.6).
template <class Signed>
void multiply_narrow(Core& core, const Op& op) {
  Signed product;
  if (__builtin_mul_overflow(core.get<Signed>(op[1]), core.get<Signed>(op[0]), &product))
    return core.set_flags(kMultiplyDivide, kOverflow);
  core.put(op[1], product);
  core.set_flags(kMultiplyDivide, sign_flags(product));
}

/// /I, /D: no remainder. Division by zero sets SM1.3 and changes nothing else.
template <class Signed>
void divide_narrow(Core& core, const Op& op) {
  const auto dividend = core.get<Signed>(op[1]), divisor = core.get<Signed>(op[0]);
  if (divisor == 0) return core.set_flags(kDivisionByZero, kDivisionByZero);
  if (divisor == -1 && dividend == std::numeric_limits<Signed>::min()) return core.set_flags(kMultiplyDivide, kOverflow);
  const auto quotient = static_cast<Signed>(dividend / divisor);
  core.put(op[1], quotient);
  core.set_flags(kMultiplyDivide, sign_flags(quotient));
}

enum class Logic { And, Or, Xor };

template <Logic logic, class Value>
void combine_words(Core& core, const Op& op) {
  const auto a = core.get<Value>(op[0]), b = core.get<Value>(op[1]);
  const auto result = static_cast<Value>(logic == Logic::And ? a & b : logic == Logic::Or ? a | b : a ^ b);
  core.put(op[1], result);
  core.set_flags(kZero, result == 0 ? kZero : 0);
}

template <class Value>
void invert(Core& core, const Op& op) {
  const auto result = static_cast<Value>(~core.get<Value>(op[0]));
  core.put(op[0], result);
  core.set_flags(kZero, result == 0 ? kZero : 0);
}

}  // namespace s7200::bodies
