#include "interpreter/analysis/effects/value_set.hpp"

#include <algorithm>
#include <limits>

namespace s7200 {

ValueRange range_of(Width width) {
  switch (width) {
    case Width::Bit:
      return {0, 1};
    case Width::Byte:
      return {0, 0xFF};
    case Width::Word:
      return {std::numeric_limits<std::int16_t>::min(), std::numeric_limits<std::int16_t>::max()};
    case Width::Double:
      break;
  }
  return {std::numeric_limits<std::int32_t>::min(), std::numeric_limits<std::int32_t>::max()};
}

ValueSet ValueSet::all_of(Width width) {
  const ValueRange range = range_of(width);
  return {range.least, range.most};
}

ValueSet ValueSet::all_of(Width width, std::uint32_t cause) {
  ValueSet all = all_of(width);
  all.cause_ = cause;
  return all;
}

std::optional<std::int64_t> ValueSet::single() const {
  if (empty() || least() != most()) return {};
  return least();
}

void ValueSet::blame(std::uint32_t op) {
  if (cause_ == kNoCause) cause_ = op;
}

void ValueSet::add(ValueRange range) {
  std::size_t at = 0;
  while (at < count_ && ranges_[at].most + 1 < range.least) ++at;
  std::size_t end = at;
  for (; end < count_ && ranges_[end].least <= range.most + 1; ++end)
    range = {std::min(range.least, ranges_[end].least), std::max(range.most, ranges_[end].most)};
  if (end == at) {
    std::copy_backward(ranges_.begin() + static_cast<std::ptrdiff_t>(at), ranges_.begin() + count_,
                       ranges_.begin() + count_ + 1);
    ++count_;
  } else {
    std::copy(ranges_.begin() + static_cast<std::ptrdiff_t>(end), ranges_.begin() + count_,
              ranges_.begin() + static_cast<std::ptrdiff_t>(at) + 1);
    count_ -= static_cast<std::uint32_t>(end - at - 1);
  }
  ranges_[at] = range;
  if (count_ <= kMost) return;
  std::size_t closest = 0;
  const auto gap = [this](std::size_t i) { return ranges_[i + 1].least - ranges_[i].most; };
  for (std::size_t i = 1; i + 1 < count_; ++i)
    if (gap(i) < gap(closest)) closest = i;
  ranges_[closest].most = ranges_[closest + 1].most;
  std::copy(ranges_.begin() + static_cast<std::ptrdiff_t>(closest) + 2, ranges_.begin() + count_,
            ranges_.begin() + static_cast<std::ptrdiff_t>(closest) + 1);
  --count_;
}

bool ValueSet::join(const ValueSet& other) {
  const ValueSet before = *this;
  for (const ValueRange& range : other.ranges()) add(range);
  if (other.cause_ != kNoCause) blame(other.cause_);
  return *this != before || cause_ != before.cause_;
}

ValueSet ValueSet::within(std::int64_t least, std::int64_t most) const {
  ValueSet result;
  for (const ValueRange& range : ranges())
    if (range.least <= most && range.most >= least) result.add({std::max(range.least, least), std::min(range.most, most)});
  result.cause_ = cause_;
  return result;
}

ValueSet ValueSet::that_are(Relation relation, const ValueSet& others) const {
  switch (relation) {
    case Relation::Equal:
      return within(others.least(), others.most());
    case Relation::NotEqual: {
      if (!others.single()) return *this;
      ValueSet below = within(least(), *others.single() - 1);
      below.join(within(*others.single() + 1, most()));
      return below;
    }
    case Relation::Greater:
      return within(others.least() + 1, most());
    case Relation::GreaterEqual:
      return within(others.least(), most());
    case Relation::Less:
      return within(least(), others.most() - 1);
    case Relation::LessEqual:
      return within(least(), others.most());
  }
  return *this;
}

ValueSet ValueSet::fitted(Width width) const {
  const ValueRange all = range_of(width);
  const bool fits = empty() || (least() >= all.least && most() <= all.most);
  return fits ? *this : all_of(width, cause_);
}

ValueSet ValueSet::plus(const ValueSet& other) const {
  ValueSet result;
  for (const ValueRange& a : ranges())
    for (const ValueRange& b : other.ranges()) result.add({a.least + b.least, a.most + b.most});
  result.cause_ = cause_ != kNoCause ? cause_ : other.cause_;
  return result;
}

ValueSet ValueSet::negated() const {
  ValueSet result;
  for (const ValueRange& range : ranges()) result.add({-range.most, -range.least});
  result.cause_ = cause_;
  return result;
}

ValueSet ValueSet::times(const ValueSet& other) const {
  ValueSet result;
  for (const ValueRange& a : ranges())
    for (const ValueRange& b : other.ranges()) {
      const auto [least, most] = std::minmax({a.least * b.least, a.least * b.most, a.most * b.least, a.most * b.most});
      result.add({least, most});
    }
  result.cause_ = cause_ != kNoCause ? cause_ : other.cause_;
  return result;
}

ValueSet ValueSet::divided_by(std::int64_t divisor) const {
  ValueSet result;
  for (const ValueRange& range : ranges()) result.add({range.least / divisor, range.most / divisor});
  result.cause_ = cause_;
  return result;
}

bool ValueSet::operator==(const ValueSet& other) const { return std::ranges::equal(ranges(), other.ranges()); }

}  // namespace s7200
