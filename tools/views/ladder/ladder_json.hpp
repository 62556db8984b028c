// Networks as ladder for machines: the tree of contacts and outputs, and the grid they are drawn in.
#pragma once

#include <nlohmann/json.hpp>

#include "interpreter/analysis/drawn_networks.hpp"
#include "tools/views/ladder/ladder_text.hpp"

namespace s7200::tools {

/// A network with its elements, their `tree` and their `grid`, or with `why_not`. With `flow` also whether its points have
/// power, and what the elements' instructions did. The keys are in tools/JSON.md.
nlohmann::ordered_json network_json(const DrawnNetwork& network, const stl::Source& program,
                                    const LadderFlow* flow = nullptr);

}  // namespace s7200::tools
