// Reads ladder drawings made of box-drawing characters, as S7-Micro/DOS printed them, into networks: what is in series, what
// is in parallel, and what hangs from it. Knows the shapes of contacts, coils and boxes, but no instruction: what `MOV_W` or
// `( CALL )` means is for program/ladder/ladder.hpp.
//
//       │ I0.0       I0.1                      Q0.0         the operand of a contact or a coil stands above it
//   1   ├─┤   ├──┬──┤ / ├────────────────────(     )        the number of the network stands before the power rail
//       │        │                            MOV_W───┐     the name of a box is part of its upper edge
//       │        └───────────────────────────┤EN      │
//       │                                K5┤IN   OUT├VW0
//       │                                    └────────┘
//
// More than Micro/DOS could draw, read as `s7200 inspect … ladder` writes it: a box whose ENO leads on, `ENO├──`; a line
// that goes on below, `──>A` and `A>──`; and in place of a drawing the STL of a network that has none, from a line `3   STL`
// to the next blank one; below the frame of a routine its local variables, `VAR_INPUT  level : INT;  // comment`, with
// what is left of the comment in lines further in.
//
// No description of these drawings was found: the shapes are those of a published tip. A wire that the page lost is an error
// and is not guessed at.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/diagnostic.hpp"
#include "interpreter/stl/ast.hpp"

namespace s7200::stl {

struct LadderText {
  std::string text;
  Position position{};
};

/// A place at the side of a box where an operand stands: `K5┤IN`, `OUT├VW0`.
struct LadderPin {
  std::string name;
  LadderText operand;
  bool output = false;  ///< at the right side
};

struct LadderElement {
  enum class Kind : std::uint8_t { Contact, Coil, Box } kind = Kind::Contact;
  std::string symbol;  ///< `/`, `NOT`, `== W`; `CALL`, or nothing for a plain coil; `MOV_W`
  Position position{};
  std::vector<LadderText> operands{};  ///< above it, from left to right
  std::vector<LadderPin> pins{};       ///< of a box, from top to bottom, without those for power flow
  std::vector<std::string> power{};    ///< the names of a box's pins for power flow, from top to bottom: EN; CU, R
  std::optional<std::uint32_t> op{};   ///< the instruction of a program that it was drawn from
};

/// Contacts between two points of a network. A series of nothing is a wire.
struct LadderPath {
  enum class Kind : std::uint8_t { Contact, Series, Parallel } kind = Kind::Series;
  LadderElement contact{};
  std::vector<LadderPath> parts{};  ///< from left to right, or from top to bottom
};

/// A way through a network: contacts up to a point, and what hangs from the point.
struct LadderBranch {
  LadderPath path{};
  std::vector<LadderBranch> branches{};   ///< from top to bottom; after an output, what hangs from its ENO
  std::optional<LadderElement> output{};  ///< a coil or a box
  std::vector<LadderPath>
      more_inputs{};  ///< of a box that takes power flow at several pins: from the rail to each but the first
};

struct LadderNetwork {
  std::uint32_t number = 0;
  Position position{};
  std::vector<std::string> comments{};  ///< lines of comment above the drawing, without the `//`
  std::optional<LadderElement> head{};  ///< the frame that begins a routine or is a label: symbol SBR, operand 50
  std::vector<Variable> variables{};    ///< that the routine of the head declares, without addresses
  LadderBranch rail{};                  ///< a wire, and what hangs from the power rail
  std::vector<LadderText> listing{};    ///< lines of STL in place of a drawing
  bool readable = true;                 ///< false: the diagnostics say why, and nothing hangs from the rail
};

struct LadderPage {
  SourceLines source;
  std::vector<LadderNetwork> networks;
  Diagnostics diagnostics;  ///< in the order of their places
};

/// Reads the drawings of a document in UTF-8, whether its box-drawing characters were decoded as such or as Windows-1252.
/// All other lines are left out. Reports, each with its place and what was expected there: a network that is damaged, a
/// network that is missing according to the numbers, a document without drawings.
LadderPage read_ladder(std::string_view text, std::string name);

}  // namespace s7200::stl
