// Reads the block exports of Micro/WIN: ORGANIZATION_BLOCK, SUBROUTINE_BLOCK, INTERRUPT_BLOCK and DATA_BLOCK.
//
// Each block becomes a routine of a linear listing: a subroutine begins with its SBR and ends with RET, an interrupt routine
// begins with its INT and ends with RETI, the main program ends with MEND and comes first, wherever it stood in the text.
// Published listings have headings in place of the keywords: a name and the Chinese word for subroutine or interrupt
// routine. What follows the reader knows no blocks, except for the names in their heads and their local variables.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/stl/is_instruction.hpp"
#include "interpreter/stl/parser.hpp"

namespace s7200::stl {

/// Whether some line begins with a word such as ORGANIZATION_BLOCK.
bool is_block_export(std::string_view text);

/// Reads one. Messages about its lines name block and network (Source::sections). With `is_instruction`, statements before
/// BEGIN are told from comments there; without it, only those with addresses.
///
/// Not documented, modelled so:
/// - Input, in-out, output and temporary variables are in local memory in this order, whichever way the text has them.
///   [Blocks.VariablesAreInLocalMemoryInTheOrderOfTheirKinds]
/// - A STRING takes four bytes: it is a pointer to the string. [Blocks.AStringTakesFourBytesOfLocalMemory]
ParseResult read_blocks(std::string_view text, std::string name, const IsInstruction& is_instruction = {});

inline constexpr std::uint32_t kLocalBytes = 64;

/// Gives the variables of a block their addresses in its local memory, in the order of their kinds. Returns the first that
/// does not fit there; null if all do.
const Variable* place_variables(std::vector<Variable>& variables);

/// Whether it is a document with the listing of a CPU 22x as Micro/WIN shows it: the Chinese heading of the main program,
/// and below it the first network.
bool has_routine_headings(std::string_view text);

/// Reads the listing of one: each heading begins a routine, which ends at the next; what stands before the first is text.
/// Routines have names and get free numbers.
ParseResult read_headed_document(std::string_view text, std::string name);

}  // namespace s7200::stl
