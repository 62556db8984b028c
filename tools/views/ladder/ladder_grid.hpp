// Where each part of a drawn network stands: columns of characters and rows of lines, worked out once for all that draw it.
//
// The power rail is column 0. A drawing that is wider than it may be goes on at the rail below, with the same letter at both
// ends: `──>A` and `A>──`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "interpreter/stl/drawings/ladder.hpp"

namespace s7200::tools {

/// Columns and rows from the upper left corner on.
struct GridText {
  std::string text;
  int column = 0, row = 0;
};

/// A pin at the side of a box: its name is inside, its operand outside.
struct GridPin {
  GridText name, operand;
  bool right = false;
  bool power = false;  ///< it is wired
};

/// Parts of a network that are wired together are one point of it; the power rail is point 0.
using GridPoint = std::size_t;

/// A contact, a coil or a box.
struct GridShape {
  stl::LadderElement::Kind kind{};
  std::string symbol;
  std::optional<std::uint32_t> op;
  std::uint32_t line = 0;                          ///< of the source
  int column = 0, row = 0, width = 0, height = 0;  ///< of a box: with its edges, the name is in the upper one
  std::vector<GridText> operands{};                ///< above it
  std::vector<GridPin> pins{};
  GridPoint from = 0, to = 0;  ///< between which it stands; `to` of an output without ENO is no point: 0
};

/// A straight line of cells, both ends included, from left to right or from top to bottom.
struct GridWire {
  int column = 0, row = 0, to_column = 0, to_row = 0;
  GridPoint point = 0;
};

/// An end of a line that goes on elsewhere: `>A` ends it, `A>` begins it.
struct GridConnector {
  GridText name;  ///< with its `>`
  bool begins = false;
  GridPoint point = 0;
};

struct LadderGrid {
  int columns = 1, rows = 0;
  int first_rung = 0;  ///< the row of the uppermost wire at the rail
  std::vector<GridShape> shapes{};
  std::vector<GridWire> wires{};
  std::vector<GridConnector> connectors{};
  std::size_t points = 1;
};

/// The grid of a network that has a form in ladder and no head, at most `columns` wide where its elements are not wider.
LadderGrid grid_of(const stl::LadderNetwork& network, int columns);

/// Whether each point has power: `closed` says of each shape, in the order of the instructions, whether it lets through what
/// reaches it, and of an edge whether power comes out of it; a NOT lets through what does not reach it.
std::vector<bool> powered_points(const LadderGrid& grid, const std::vector<bool>& closed);

}  // namespace s7200::tools
