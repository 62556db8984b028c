// Which memory an instruction is about to read or write.
#pragma once

#include <cstdint>
#include <vector>

#include "interpreter/analysis/bits.hpp"
#include "interpreter/cpu/cpu.hpp"
#include "interpreter/program/address.hpp"

namespace s7200::tools {

Bits bits_of(const MemoryRange& range);

enum class Access : std::uint8_t { Read, Write };

/// The memory of the operands of `op` that it would read or write if it were executed now with power flow: blocks as long as
/// their counts say, and what pointers point to. Not the entries of tables, strings and messages, nor what the system
/// writes.
std::vector<Bits> accessed(const Cpu& cpu, std::uint32_t op, Access access);

/// Whether `op` may ever do so in `range`, whatever pointers and counts will be: quicker to ask first.
bool may_access(const Cpu& cpu, std::uint32_t op, Access access, const Bits& range);

/// Whether one of them is in `range`.
bool accesses(const Cpu& cpu, std::uint32_t op, Access access, const Bits& range);

}  // namespace s7200::tools
