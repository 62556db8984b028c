// Words of memory as numbers.
#pragma once

#include <bit>
#include <cstdint>

#include "tests/reference_model/machine.hpp"

namespace s7200::reference {

inline std::int32_t signed16(std::uint32_t word) { return static_cast<std::int16_t>(word); }
inline std::int32_t signed32(std::uint32_t value) { return static_cast<std::int32_t>(value); }
inline float real(std::uint32_t value) { return std::bit_cast<float>(value); }

enum Flag {
  kZero = 0,
  kOverflow = 1,
  kNegative = 2,
  kDivisionByZero = 3,
  kTableFull = 4,
  kTableEmpty = 5,
  kNotBcd = 6,
  kNotHex = 7
};

inline void set_flag(Machine& m, Flag flag, bool value) { write(m.flag(flag), value); }

}  // namespace s7200::reference
