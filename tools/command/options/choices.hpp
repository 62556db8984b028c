// The values that an option takes, for shells that complete them.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class Option;
}

namespace s7200::tools {

/// Names the values for completion. What the option takes is for its own check to say.
CLI::Option* offer(CLI::Option* option, const std::vector<std::string>& values);

/// Those offered, and those of a CLI::IsMember; empty if the option takes other values too.
std::vector<std::string> offered_by(CLI::Option& option);

}  // namespace s7200::tools
