// Reads STL from a published document: leaves out ladder drawings, headings, page debris and prose, keeps comments.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "interpreter/stl/ast.hpp"
#include "interpreter/stl/is_instruction.hpp"
#include "interpreter/stl/parser.hpp"

namespace s7200::stl {

/// Advice about a mnemonic that does not exist.
struct Advice {
  std::string what;  ///< that of another language or family: "a German mnemonic"; empty otherwise
  std::string hint;  ///< what to write instead; may be empty
};

/// The reader's questions about mnemonics (upper case). The caller asks the instruction table, which stl/ does not know.
struct InstructionSet {
  IsInstruction has;
  std::function<Advice(std::string_view mnemonic)> advice_on;
};

/// The beginning of the causes of diagnostics about routines without MEND, RET or RETI. A caller that takes the listing for
/// that of a CPU 22x, which needs none, leaves these diagnostics out.
inline constexpr std::string_view kMissingEnd = "missing end of ";

/// Whether `text` (UTF-8) is a document and not a plain STL file: it has ladder drawings, or prose around its STL.
/// A plain STL file with mistakes is not a document: its mistakes must be reported, not left out.
bool is_document(std::string_view text, const InstructionSet& instructions);

/// The plain STL file in a text; nothing if it is a document.
std::optional<ParseResult> read_listing(std::string_view text, std::string name, const InstructionSet& instructions);

/// Reads the STL of a document. Positions and `text` are those of the document. Reports, each with its place: a document
/// without STL, a line of STL that is damaged, a line between the statements of a routine that may be one, a listing that
/// stops in the middle of a routine. A text that is not a document is a listing from its first line to its last.
ParseResult read_document(std::string_view text, std::string name, const InstructionSet& instructions);

}  // namespace s7200::stl
