// Reads STL from a published document: leaves out ladder drawings, headings, page debris and prose, keeps comments.
#pragma once

#include <functional>
#include <string_view>

#include "interpreter/stl/ast.hpp"
#include "interpreter/stl/parser.hpp"

namespace s7200::stl {

/// Whether there is an instruction of this mnemonic (upper case) with this many operands. The caller asks the instruction
/// table, which stl/ does not know.
using IsInstruction = std::function<bool(std::string_view mnemonic, std::size_t operands)>;

/// Whether `text` (UTF-8) is a document and not a plain STL file: it has ladder drawings, or prose around its STL.
/// A plain STL file with mistakes is not a document: its mistakes must be reported, not left out.
bool is_document(std::string_view text, const IsInstruction& is_instruction);

/// Reads the STL of a document. Positions and `text` are those of the document. Reports, each with its place: a document
/// without STL, a line of STL that is damaged, a listing that stops in the middle of a routine.
ParseResult read_document(std::string_view text, std::string name, const IsInstruction& is_instruction);

}  // namespace s7200::stl
