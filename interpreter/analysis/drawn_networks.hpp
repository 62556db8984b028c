// The networks of a program as ladder: what is in series, what is in parallel, and what hangs from it.
//
// Works on the statements alone, so a program with errors is drawn as far as it can be. A network is drawn only if the logic
// stack does nothing that contacts in series and in parallel, branches and boxes in a row do not do.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "interpreter/stl/ast.hpp"
#include "interpreter/stl/drawings/ladder.hpp"

namespace s7200 {

struct DrawnNetwork {
  std::string routine;               ///< `MAIN`, `SBR_51`, `INT_123`
  std::string title;                 ///< of its NETWORK line
  std::uint32_t first = 0, end = 0;  ///< its instructions: from the first until before `end`
  stl::LadderNetwork ladder;         ///< its elements know their instructions; without a form in ladder nothing hangs there
  std::string why_not;               ///< why it has no form in ladder; empty if it has one
  std::uint32_t why_not_op = 0;      ///< the instruction that has none
  std::vector<std::string> other_stl{};  ///< what the drawing is in STL, where the program does the same with other
                                         ///< instructions: A for LD and ALD, one LPS for two
};

/// All networks, in the order of the program. Without NETWORK lines each rung is one, and they are counted through each
/// routine. The head of a routine and a label stand alone here, and what follows has the same number.
std::vector<DrawnNetwork> drawn_networks(const stl::Source& program);

}  // namespace s7200
