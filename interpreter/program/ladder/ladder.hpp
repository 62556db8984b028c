// From drawn networks to STL: which instruction a contact, a coil or a box stands for.
//
// A box with a result of its own becomes a move and an instruction that changes the result, as in the STL beside the
// published drawings: IN1 and IN2 of ADD_I give MOVW IN1, OUT and +I IN2, OUT. Where OUT is one of the inputs, no move is
// needed.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "interpreter/base/result.hpp"
#include "interpreter/program/load.hpp"
#include "interpreter/stl/drawings/ladder.hpp"

namespace s7200 {

/// The STL of a page, each network under its number. Positions are those of the drawing, so that what the checker has to say
/// is said about the drawing. A network that cannot be read or written in STL has a head and no statements; the diagnostics
/// say why.
stl::ParseResult ladder_to_stl(const stl::LadderPage& page);

/// The drawings in a text in any of the encodings of stl/text/encoding.hpp, as STL. Trouble if the
/// bytes are not text.
Result<SourceText> read_drawings(std::string_view bytes, const std::string& name);

}  // namespace s7200
