// Bodies: real arithmetic (facts 6.6). Reals are IEEE-754 single precision.
//
// An illegal operand, a result out of range, and the root of a negative number set SM1.1 and leave the operands unchanged;
// SM1.0 and SM1.2 are then not valid (S7-200 manual from 2004 on, 140) and are 0 here.
//
// Not documented, modelled so:
// - An infinite operand is illegal, just like one that is not a number, even as a divisor. [Vectors.ADD_R, Vectors.DIV_R]
// - /R by 0 sets SM1.3 whatever the dividend is, even if it is not a number. [Vectors.DIV_R]
#pragma once

#include <cmath>
#include <limits>

#include "interpreter/instructions/math.hpp"

namespace s7200::bodies {

/// An operand that is infinite or not a number gives such a result, except as a divisor.
inline void store_real(Core& core, const Operand& out, float result) {
  if (!std::isfinite(result)) return core.set_flags(kArithmetic, kOverflow);
  core.put(out, result);
  core.set_flags(kArithmetic, sign_flags(result));
}

enum class RealOperation { Add, Subtract, Multiply };

/// +R, -R, *R: OUT op IN1 to OUT.
template <RealOperation operation>
void real_arithmetic(Core& core, const Op& op) {
  const auto a = core.get<float>(op[1]), b = core.get<float>(op[0]);
  const float result = operation == RealOperation::Add ? a + b : operation == RealOperation::Subtract ? a - b : a * b;
  store_real(core, op[1], result);
}

/// /R: division by zero sets SM1.3 and changes nothing else (S7-200 manual from 2004 on, 140).
inline void real_divide(Core& core, const Op& op) {
  const auto dividend = core.get<float>(op[1]), divisor = core.get<float>(op[0]);
  if (divisor == 0) return core.set_flags(kDivisionByZero, kDivisionByZero);
  core.set_flags(kDivisionByZero, 0);
  store_real(core, op[1], std::isfinite(divisor) ? dividend / divisor : divisor);
}

enum class Function { Sine, Cosine, Tangent, Logarithm, Exponential };

/// SIN, COS, TAN of an angle in radians; LN, EXP.
/// Not documented, modelled so: the result is the exact one, rounded to a real, for angles of any size.
/// [Vectors.SIN, Vectors.TAN]
template <Function function>
void real_function(Core& core, const Op& op) {
  const double in = static_cast<double>(core.get<float>(op[0]));
  const double result = function == Function::Sine        ? std::sin(in)
                        : function == Function::Cosine    ? std::cos(in)
                        : function == Function::Tangent   ? std::tan(in)
                        : function == Function::Logarithm ? std::log(in)
                                                          : std::exp(in);
  store_real(core, op[1], std::isfinite(in) ? static_cast<float>(result) : std::numeric_limits<float>::quiet_NaN());
}

inline void square_root(Core& core, const Op& op) {
  store_real(core, op[1], std::sqrt(core.get<float>(op[0])));  // NaN below 0
}

}  // namespace s7200::bodies
