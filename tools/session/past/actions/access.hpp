// Which memory an instruction is about to read or write.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "interpreter/analysis/effects/bits.hpp"
#include "interpreter/cpu/cpu.hpp"
#include "interpreter/program/operands/address.hpp"

namespace s7200::tools {

Bits bits_of(const MemoryRange& range);

enum class Access : std::uint8_t { Read, Write };

/// The memory of the operands of `op` that it would read or write if it were executed now with power flow: blocks as long as
/// their counts say, and what pointers point to. A CALL writes what it hands over to the local memory of its subroutine, a
/// return what its CALL gets back. Not the entries of tables, strings and messages, nor what the system writes.
std::vector<Bits> accessed(const Cpu& cpu, std::uint32_t op, Access access);

/// Whether `op` may ever do so in `range`, whatever pointers and counts will be: quicker to ask first.
bool may_access(const Cpu& cpu, std::uint32_t op, Access access, const Bits& range);

/// Whether one of them is in `range`.
bool accesses(const Cpu& cpu, std::uint32_t op, Access access, const Bits& range);

/// Those of a CALL.
std::span<const Parameter> parameters_of(const Program& program, std::uint32_t call);

/// Where the subroutine has a parameter.
Bits local_bits(const Parameter& parameter);

/// RET, or CRET.
bool returns_from_subroutine(const Op& op);

/// The CALL that `op` would end if it were executed now; nothing if it does not return from a subroutine.
std::optional<std::uint32_t> call_that_ends(const Cpu& cpu, std::uint32_t op);

}  // namespace s7200::tools
