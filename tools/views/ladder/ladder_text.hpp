// The networks of a program as ladder, drawn with characters. `s7200 import --from ladder` reads them back.
#pragma once

#include <string>
#include <vector>

#include "interpreter/analysis/drawn_networks.hpp"
#include "tools/views/ladder/ladder_grid.hpp"

namespace s7200::tools {

/// What a drawing shows of a moment.
struct LadderFlow {
  std::vector<bool> points;         ///< whether they have power, as powered_points() says
  std::vector<std::string> values;  ///< of each shape; empty where nothing is known
};

inline constexpr int kLadderColumns = 100;

/// The rows of a grid with the power rail, without the number of the network. What has power in `flow` has double lines.
std::vector<std::string> grid_text(const LadderGrid& grid, bool ascii, const LadderFlow* flow = nullptr);

/// A network: its title, its comments, the drawing, and what the symbols and comments in it say; or why it has no drawing,
/// and its STL. `program` is what it was drawn from.
std::string network_text(const DrawnNetwork& network, const stl::Source& program, bool ascii,
                         const LadderFlow* flow = nullptr);

/// Several networks, with a blank line after each.
std::string ladder_text(const std::vector<DrawnNetwork>& networks, const stl::Source& program, bool ascii);

/// Whether a network only goes on after the head of a routine or a label, so that it has no name of its own.
bool goes_on(const DrawnNetwork& network, const DrawnNetwork& head);

/// `MAIN, network 3: title`
std::string name_of(const DrawnNetwork& network);

/// The grid of a network at the width of network_text().
LadderGrid grid_of(const DrawnNetwork& network);

/// A line for each network without a form in ladder: `MAIN, network 3, line 12: why`; empty if there is none.
std::string undrawn_text(const std::vector<DrawnNetwork>& networks, const stl::Source& program);

/// The statements of a program, by instruction.
std::vector<const stl::Statement*> statements_of(const stl::Source& program);

/// What is known of an address of a network besides its value.
struct LadderNote {
  std::string text;     ///< the address, or the instruction with a comment of its own
  std::string symbol;   ///< empty if it has none
  std::string comment;  ///< of the symbol, or of the line
};

/// `network is not representable in ladder: …` of a network without a form in ladder.
std::string why_not_text(const DrawnNetwork& network);

/// `drawn, it is the same with other instructions: LD I0.0; A I0.1; = Q0.0`; empty where it is with its own.
std::string other_stl_text(const DrawnNetwork& network);

/// The notes in columns, below a drawing.
std::vector<std::string> notes_text(const DrawnNetwork& network, const stl::Source& program);

std::vector<LadderNote> notes_on(const DrawnNetwork& network, const stl::Source& program);

}  // namespace s7200::tools
