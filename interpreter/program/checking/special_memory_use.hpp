// Operands in special memory that the CPU makes no use of, or that it would use for something that is not modelled.
#pragma once

#include <cstdint>
#include <string>

#include "interpreter/base/diagnostic.hpp"
#include "interpreter/program/operands/operands.hpp"

namespace s7200 {

/// Bytes of special memory, from SMB`first` on.
struct SpecialBytes {
  std::uint32_t first = 0, count = 1;

  bool overlap(const SpecialMemory& row) const { return first + count > row.first && first <= row.last; }
};

/// The first row among the bytes that is refused on a CPU; null if there is none.
const SpecialMemory* refused_special_memory(const CpuModel& model, const SpecialBytes& bytes);

/// Whether the CPU acts on a byte of special memory as the manual says.
bool is_modelled_special_memory(const CpuModel& model, std::uint32_t byte);

/// `SMB8 to SMB21`
std::string bytes_text(const SpecialMemory& memory);

/// Adds a warning for the bytes of an operand that the CPU makes no use of. `operand` is its number in the statement. A word
/// over a byte that it does use, and over others that it does not, is said to be one.
void warn_of_special_memory(const CpuModel& model, const SpecialBytes& bytes, const OperandRule& rule,
                            const stl::Statement& statement, std::size_t operand, stl::Diagnostics& diagnostics);

}  // namespace s7200
