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

/// The same where a file may stand too: they are offered to who has begun to type one.
CLI::Option* offer_beside_files(CLI::Option* option, const std::vector<std::string>& values);

/// The values depend on what another option is given; the first are offered if it is not.
struct OfferedWith {
  std::string value;  ///< of the other option
  std::vector<std::string> values{};
};
CLI::Option* offer_with(CLI::Option* option, const std::string& other, const std::vector<OfferedWith>& offers);

/// Those offered where `typed` is what there is of the value, and those of a CLI::IsMember; empty if the option takes other
/// values too. `words`: of the command line so far.
std::vector<std::string> offered_by(CLI::Option& option, const std::string& typed, const std::vector<std::string>& words);

}  // namespace s7200::tools
