// The relations of comparisons, contacts and searches in tables.
#pragma once

#include <array>
#include <cstddef>
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

/// Holds where `relation` does not.
constexpr Relation opposite(Relation relation) {
  constexpr std::array kOpposite{Relation::NotEqual, Relation::Equal,        Relation::LessEqual,
                                 Relation::Less,     Relation::GreaterEqual, Relation::Greater};
  return kOpposite[static_cast<std::size_t>(relation)];
}

/// Holds between b and a where `relation` holds between a and b.
constexpr Relation mirrored(Relation relation) {
  constexpr std::array kMirrored{Relation::Equal,     Relation::NotEqual, Relation::Less,
                                 Relation::LessEqual, Relation::Greater,  Relation::GreaterEqual};
  return kMirrored[static_cast<std::size_t>(relation)];
}

}  // namespace s7200
