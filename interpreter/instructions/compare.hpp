// Bodies: compare contacts (facts 6.3). Bytes are unsigned, words and double words signed.
#pragma once

#include "interpreter/instructions/bit_logic.hpp"

namespace s7200::bodies {

enum class Relation { Equal, NotEqual, Greater, GreaterEqual, Less, LessEqual };

template <Relation relation, class Value>
bool holds(Value a, Value b) {
  switch (relation) {
    case Relation::Equal:
      return a == b;
    case Relation::NotEqual:
      return a != b;
    case Relation::Greater:
      return a > b;
    case Relation::GreaterEqual:
      return a >= b;
    case Relation::Less:
      return a < b;
    case Relation::LessEqual:
      return a <= b;
  }
}

template <Join join, Relation relation, class Value, Rail rail = Rail::Always>
void compare(Cpu& cpu, const Op& op) {
  combine<join>(cpu.s.stack, holds<relation>(cpu.get<Value>(op[0]), cpu.get<Value>(op[1])) && fed<join, rail>(cpu));
}

}  // namespace s7200::bodies
