// Bytes, and big-endian access, the S7-200's byte order: VW100 is VB100 (high) and VB101 (low).
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <vector>

namespace s7200 {

using Bytes = std::vector<std::uint8_t>;

inline std::uint16_t load16(const std::uint8_t* from) {
  std::uint16_t value;
  std::memcpy(&value, from, sizeof value);
  return __builtin_bswap16(value);
}

inline std::uint32_t load32(const std::uint8_t* from) {
  std::uint32_t value;
  std::memcpy(&value, from, sizeof value);
  return __builtin_bswap32(value);
}

inline void store16(std::uint8_t* to, std::uint16_t value) {
  value = __builtin_bswap16(value);
  std::memcpy(to, &value, sizeof value);
}

inline void store32(std::uint8_t* to, std::uint32_t value) {
  value = __builtin_bswap32(value);
  std::memcpy(to, &value, sizeof value);
}

static_assert(std::endian::native == std::endian::little, "the byte swaps above assume a little-endian host");

}  // namespace s7200
