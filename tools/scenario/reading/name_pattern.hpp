// Patterns of names, as shells have them.
#pragma once

#include <string_view>

namespace s7200::tools {

/// Whether a text, as a whole and without regard to case, is what a pattern says: * any characters, ? one, [a-z] one of
/// these, [!a-z] one of all others; a backslash takes the meaning from what follows. A [ without its ] is itself.
bool matches_pattern(std::string_view text, std::string_view pattern);

}  // namespace s7200::tools
