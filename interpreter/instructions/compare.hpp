// Bodies: compare contacts (facts 6.3). Bytes are unsigned, words and double words signed.
//
// A real operand that is not a number stops the CPU (facts 5.1, 9.1).
//
// Not documented, modelled so: infinities compare like the largest and the smallest number. [Vectors.LDR_GE]
#pragma once

#include <cmath>
#include <type_traits>

#include "interpreter/instructions/bit_logic.hpp"
#include "interpreter/model/relation.hpp"

namespace s7200::bodies {

template <Join join, Relation relation, class Value, Rail rail = Rail::Always>
void compare(Core& core, const Op& op) {
  const auto a = core.get<Value>(op[0]), b = core.get<Value>(op[1]);
  if constexpr (std::is_floating_point_v<Value>)
    if (std::isunordered(a, b)) return core.compare_error(RunError::CompareValue, FatalError::CompareValue);
  combine<join>(core.s.stack, holds(relation, a, b) && fed<join, rail>(core));
}

template <Join join, Relation relation, class Value>
inline constexpr Bodies kCompare{compare<join, relation, Value>, compare<join, relation, Value, Rail::Segment>,
                                 std::is_integral_v<Value> ? linked::on_stack<compare<join, relation, Value>> : nullptr};

}  // namespace s7200::bodies
