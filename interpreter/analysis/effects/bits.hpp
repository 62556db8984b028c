// Bits of the image.
#pragma once

#include <cstdint>

namespace s7200 {

/// Numbered from bit 0 of the first byte of the image; eight times a place in the image is the number of its bit 0.
struct Bits {
  std::uint64_t first = 0, count = 1;

  std::uint64_t end() const { return first + count; }
  bool overlaps(const Bits& other) const { return first < other.end() && other.first < end(); }
  bool contains(const Bits& other) const { return other.first >= first && other.end() <= end(); }
  bool operator==(const Bits&) const = default;
};

}  // namespace s7200
