// What a word of a command may become: for the tab key, and for editors.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/session/commands/session.hpp"

namespace s7200::tools {

/// What the word that ends a line may become, and how long it is.
struct Offers {
  std::size_t word = 0;
  std::vector<std::string> candidates{};
};

/// Commands, addresses and symbols, places, files.
Offers completions(const Session& session, std::string_view line);

}  // namespace s7200::tools
