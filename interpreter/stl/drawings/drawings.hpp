// Contacts and coils that are drawn with characters where STL should be: `--| |--|/|--( )--`, `-|P|-`, `--] [--`.
#pragma once

#include <string_view>

#include "interpreter/stl/document.hpp"
#include "interpreter/stl/parser.hpp"

namespace s7200::stl {

/// The message about a ladder drawing, and what to do with one.
inline constexpr std::string_view kIsDrawing = "this is a ladder drawing, not STL";
inline constexpr std::string_view kForDrawing =
    "write it as STL: -| |- is LD, A or O; -|/|- is LDN, AN or ON; -( )- is =. `s7200 import --from ladder` reads drawings in "
    "box-drawing characters, as S7-Micro/DOS printed them: ├──┤ ├──";

/// Whether a line has a contact or a coil that is drawn, or box-drawing characters.
bool has_drawing(std::string_view line);

/// Replaces the messages about the lines of ladder drawings, and about the rows of operands beside them, by one message, and
/// takes out the statements that such a row was read as. `source.text` must have the lines that were read.
void name_drawings(ParseResult& read, const InstructionSet& instructions);

}  // namespace s7200::stl
