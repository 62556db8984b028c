// STL out of a published document: ladder drawings, headings, page debris and prose are left out, comments kept.
#pragma once

#include <functional>
#include <string_view>

#include "interpreter/stl/ast.hpp"
#include "interpreter/stl/parser.hpp"

namespace s7200::stl {

/// Whether a mnemonic (upper case) with that many operands exists. The instruction table answers it; stl/ knows no table.
using IsInstruction = std::function<bool(std::string_view mnemonic, std::size_t operands)>;

/// Whether `text` (UTF-8) is a document rather than a plain STL file: it has ladder drawings, or prose around its STL.
/// A plain STL file with mistakes in it is not a document: its mistakes are to be reported, not left out.
bool is_document(std::string_view text, const IsInstruction& is_instruction);

/// Reads the STL of a document. Positions and `text` are those of the document. Errors, each located: no STL in it; a line
/// that is STL but damaged; a listing that stops in the middle of a routine.
ParseResult read_document(std::string_view text, std::string name, const IsInstruction& is_instruction);

}  // namespace s7200::stl
