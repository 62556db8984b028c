// Memory as programs name it: the text of any bits of the image.
#pragma once

#include <optional>
#include <string>

#include "interpreter/analysis/effects/bits.hpp"
#include "interpreter/program/program.hpp"

namespace s7200 {

/// The memory that a program names when it means these bits: a timer's or counter's bit is its whole element (T33), part of
/// an accumulator is the accumulator (AC0), an input or output point is the bit of its image register (I0.0).
Bits as_named(const Bits& bits);

/// `V100.3`, `VB100`, `VW100`, `T33`, `AC0`; of several things the first and the last: `VB100 to VB119`, `M0.0 to M0.5`.
std::string memory_text(const Bits& bits);

/// `*VD50`: what the pointer in memory at `at` leads to; `SMW168`, which is a number of V and no pointer.
std::string pointer_text(std::uint32_t at);

/// All of an area that a CPU has.
Bits bits_of_area(const CpuModel& model, Area area);

/// The area of memory as as_named() gives it.
Area area_of(const Bits& bits);

/// The memory that a symbol stands for; nothing for a constant, a block, or an address that the program's CPU does not have.
std::optional<Bits> bits_of(const Program& program, const stl::Symbol& symbol);

}  // namespace s7200
