// The wires of one network as a graph, and its reduction to series and parallel. Part of the reader in ladder.cpp.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "interpreter/stl/drawings/ladder.hpp"

namespace s7200::stl {

/// Points of a network that are wired together have the same number; the power rail is 0.
struct LadderGraph {
  struct Contact {
    std::size_t from = 0, to = 0;
    LadderElement element;
  };
  struct Output {
    std::vector<std::size_t> inputs;  ///< one, or as many as the box has pins for power flow
    LadderElement element;
    std::optional<std::size_t> eno{};  ///< of a box whose ENO is wired
  };

  std::size_t points = 1;
  std::vector<Contact> contacts;  ///< from top to bottom, from left to right
  std::vector<Output> outputs;    ///< likewise
};

/// Says what is wrong at a place of the drawing, and what to do.
using LadderComplaint = std::function<void(const Position& at, std::string message, std::string hint)>;

/// The branch that hangs from the power rail. Complains, and the result is of no use, if something leads nowhere or comes
/// from nowhere, or if contacts are joined in another way than in series and in parallel.
LadderBranch branches_of(LadderGraph graph, const LadderComplaint& complain);

}  // namespace s7200::stl
