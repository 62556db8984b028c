// Bodies: integer arithmetic, increment and decrement, logic (facts 6.6, 6.7).
//
// Not documented, modelled so: on overflow SM1.1 is set and the wrapped result stored; SM1.0 and SM1.2 show what was stored.
// [Vectors.ADD_I]
#pragma once

#include <type_traits>

#include "interpreter/cpu/cpu.hpp"

namespace s7200::bodies {

template <class Signed>
std::uint8_t sign_flags(Signed value) {
  return static_cast<std::uint8_t>((value == 0 ? kZero : 0) | (value < 0 ? kNegative : 0));
}

inline constexpr std::uint8_t kArithmetic = kZero | kOverflow | kNegative;

template <class Signed>
void store_result(Cpu& cpu, const Operand& out, Signed value, bool overflow) {
  cpu.put(out, value);
  cpu.set_flags(kArithmetic, static_cast<std::uint8_t>(sign_flags(value) | (overflow ? kOverflow : 0)));
}

/// +I, +D
template <class Signed>
void add(Cpu& cpu, const Op& op) {
  Signed result;
  const bool overflow = __builtin_add_overflow(cpu.get<Signed>(op[1]), cpu.get<Signed>(op[0]), &result);
  store_result(cpu, op[1], result, overflow);
}

/// -I, -D
template <class Signed>
void subtract(Cpu& cpu, const Op& op) {
  Signed result;
  const bool overflow = __builtin_sub_overflow(cpu.get<Signed>(op[1]), cpu.get<Signed>(op[0]), &result);
  store_result(cpu, op[1], result, overflow);
}

/// INCW, INCD, DECW, DECD
template <class Signed, int step>
void increment(Cpu& cpu, const Op& op) {
  Signed result;
  const bool overflow = __builtin_add_overflow(cpu.get<Signed>(op[0]), Signed{step}, &result);
  store_result(cpu, op[0], result, overflow);
}

/// INCB, DECB: wrap without overflow.
template <int step>
void increment_byte(Cpu& cpu, const Op& op) {
  const auto result = static_cast<std::uint8_t>(cpu.get<std::uint8_t>(op[0]) + step);
  cpu.put(op[0], result);
  cpu.set_flags(kZero, result == 0 ? kZero : 0);
}

/// The low word of a double word operand.
inline Operand low_word(const Operand& operand) {
  Operand low = operand;
  low.at += 2;
  return low;
}

/// MUL: 16 × 16 = 32 bits, the second factor is the low word of OUT.
inline void multiply(Cpu& cpu, const Op& op) {
  const std::int32_t product = std::int32_t{cpu.get<std::int16_t>(op[0])} * cpu.get<std::int16_t>(low_word(op[1]));
  cpu.put(op[1], product);
  cpu.set_flags(kArithmetic | kDivisionByZero, sign_flags(product));
}

/// DIV: dividend in the low word of OUT; quotient to the low word, remainder to the high word. Flags are the quotient's.
/// Division by zero sets SM1.3 and changes nothing else (S7-200 manual C233-01, 9-76).
/// Not documented, modelled so: -32768 / -1 stores the wrapped quotient 16#8000 and remainder 0, and sets SM1.1.
/// [Vectors.DIV]
inline void divide(Cpu& cpu, const Op& op) {
  const std::int32_t divisor = cpu.get<std::int16_t>(op[0]);
  if (divisor == 0) return cpu.set_flags(kDivisionByZero, kDivisionByZero);
  const std::int32_t dividend = cpu.get<std::int16_t>(low_word(op[1]));
  const auto quotient = static_cast<std::int16_t>(dividend / divisor);
  cpu.put(op[1], static_cast<std::int16_t>(dividend % divisor));
  cpu.put(low_word(op[1]), quotient);
  const bool overflow = dividend / divisor != quotient;
  cpu.set_flags(kArithmetic | kDivisionByZero, static_cast<std::uint8_t>(sign_flags(quotient) | (overflow ? kOverflow : 0)));
}

enum class Logic { And, Or, Xor };

template <Logic logic, class Value>
void combine_words(Cpu& cpu, const Op& op) {
  const auto a = cpu.get<Value>(op[0]), b = cpu.get<Value>(op[1]);
  const auto result = static_cast<Value>(logic == Logic::And ? a & b : logic == Logic::Or ? a | b : a ^ b);
  cpu.put(op[1], result);
  cpu.set_flags(kZero, result == 0 ? kZero : 0);
}

template <class Value>
void invert(Cpu& cpu, const Op& op) {
  const auto result = static_cast<Value>(~cpu.get<Value>(op[0]));
  cpu.put(op[0], result);
  cpu.set_flags(kZero, result == 0 ? kZero : 0);
}

}  // namespace s7200::bodies
