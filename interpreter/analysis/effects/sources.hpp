// Where the value comes from that an instruction puts somewhere.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "interpreter/analysis/effects/bits.hpp"
#include "interpreter/program/program.hpp"

namespace s7200 {

/// The bits that op number `op` of a program moves to `written`, some of what it writes, if it finds the memory `image`: of
/// moves and conversions the same ones of their input, of SHRB its data bit or the neighbour. They may be constants of the
/// program. Nothing if it computes a value from several, or if `written` is what a conversion fills up.
std::optional<Bits> source_of(const Program& program, std::uint32_t op, const Bits& written,
                              std::span<const std::uint8_t> image);

/// Whether bits are of a constant; then whether the first of them is 1.
std::optional<bool> constant_bit(const Program& program, const Bits& bits);

}  // namespace s7200
