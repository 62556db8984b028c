// Which network of one program is which network of another one.
//
// First networks with the same instructions belong together, in their routine and then anywhere; of those in one routine the
// longest row in the same order stayed, the others have moved. Then what has the same title in its routine, and last what is
// most alike: at least half of the words of its instructions are the same.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/compare/networks.hpp"

namespace s7200::tools {

struct NetworkMatch {
  std::optional<std::size_t> older, newer;  ///< nothing: it was added, or removed
  bool same = false;                        ///< they have the same instructions
  bool moved = false;                       ///< to another place among the networks that stayed, or to another routine
};

/// In the order of the new program; what was removed comes where it stood.
std::vector<NetworkMatch> match_networks(const std::vector<ComparedNetwork>& older,
                                         const std::vector<ComparedNetwork>& newer);

/// Pairs of equal texts, ascending on both sides: as many as there can be. Of very long rows only what is alike at both
/// ends.
std::vector<std::pair<std::size_t, std::size_t>> common_row(const std::vector<std::string>& older,
                                                            const std::vector<std::string>& newer);

}  // namespace s7200::tools
