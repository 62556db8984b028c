// The relations of comparisons, contacts and searches in tables.
#pragma once

#include <cstdint>

namespace s7200 {

enum class Relation : std::uint8_t { Equal, NotEqual, Greater, GreaterEqual, Less, LessEqual };

template <class Value>
constexpr bool holds(Relation relation, Value a, Value b) {
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
  return false;
}

}  // namespace s7200
