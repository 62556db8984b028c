// Reads one network of a ladder drawing: from rows of characters to elements and wires. Part of the reader in ladder.cpp.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "interpreter/stl/drawings/ladder.hpp"

namespace s7200::stl {

/// A line of a drawing, without the debris before it.
struct LadderRow {
  std::uint32_t line = 0;
  std::u32string cells;                ///< box-drawing characters as such, however they were decoded
  std::vector<std::uint32_t> columns;  ///< of each cell in the document

  char32_t at(std::size_t column) const { return column < cells.size() ? cells[column] : U' '; }
};

/// The sides of a cell to which its wire leads.
enum WireSide : std::uint8_t { kLeft = 1, kRight = 2, kUp = 4, kDown = 8 };

/// The sides of a box-drawing character with single or double lines; none for any other.
std::uint8_t wire_sides(char32_t character);

inline bool is_blank_cell(char32_t cell) { return cell == U' ' || cell == U'\u00A0'; }

/// Cells from `from` until before `to`, as UTF-8, without the blanks around them.
std::string text_of(const LadderRow& row, std::size_t from, std::size_t to);

/// The place of these cells in the document.
Position place_of(const LadderRow& row, std::size_t from, std::size_t length);

/// Reads the rows of `network` with its power rail in column `rail`; adds what is wrong with them to `diagnostics`.
void read_network(std::span<const LadderRow> rows, std::size_t rail, LadderNetwork& network, Diagnostics& diagnostics);

}  // namespace s7200::stl
