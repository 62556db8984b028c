// Numbers that a byte, a word or a double word may hold: a few ranges.
//
// Bytes are unsigned, words and double words signed, as comparisons take them (facts 6.3). A pointer is a double word: its
// top byte is the area, the rest counts bytes.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "interpreter/model/area.hpp"
#include "interpreter/model/relation.hpp"

namespace s7200 {

/// Numbers from `least` to `most`, both included.
struct ValueRange {
  std::int64_t least = 0, most = 0;

  bool operator==(const ValueRange&) const = default;
};

class ValueSet {
 public:
  static constexpr std::uint32_t kNoCause = 0xFFFF'FFFF;

  /// The set of no number: no way leads to the place where it would be held.
  ValueSet() = default;
  ValueSet(std::int64_t least, std::int64_t most) { add({least, most}); }

  /// All numbers of a width.
  static ValueSet all_of(Width width);
  /// All numbers of a width, because of op number `cause`.
  static ValueSet all_of(Width width, std::uint32_t cause);

  std::span<const ValueRange> ranges() const { return {ranges_.data(), count_}; }  ///< by number, apart from each other
  bool empty() const { return count_ == 0; }
  std::int64_t least() const { return ranges_[0].least; }         ///< of a set that is not empty
  std::int64_t most() const { return ranges_[count_ - 1].most; }  ///< the same
  bool is_all_of(Width width) const { return *this == all_of(width); }
  std::optional<std::int64_t> single() const;  ///< its only number

  /// The op because of which more numbers are in it than can be told apart; kNoCause if there is none.
  std::uint32_t cause() const { return cause_; }
  void blame(std::uint32_t op);  ///< unless it has a cause

  bool join(const ValueSet& other);  ///< adds the other's numbers; whether that is more than before
  void add(ValueRange range);        ///< keeps few ranges: those that are closest become one
  /// The numbers from `least` to `most` of it.
  ValueSet within(std::int64_t least, std::int64_t most) const;
  /// The numbers of it that have the relation with some number of `others`; neither set is empty.
  ValueSet that_are(Relation relation, const ValueSet& others) const;
  /// All of a width if some number does not fit it.
  ValueSet fitted(Width width) const;

  ValueSet plus(const ValueSet& other) const;
  ValueSet negated() const;
  ValueSet times(const ValueSet& other) const;
  ValueSet divided_by(std::int64_t divisor) const;  ///< rounded towards 0; the divisor is above 0

  /// Compares the numbers, not the cause.
  bool operator==(const ValueSet& other) const;

 private:
  static constexpr std::size_t kMost = 4;

  std::array<ValueRange, kMost + 1> ranges_{};
  std::uint32_t count_ = 0, cause_ = kNoCause;
};

/// The range of all numbers of a width.
ValueRange range_of(Width width);

}  // namespace s7200
