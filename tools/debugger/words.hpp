// What the commands of the debugger have in common when they read their arguments.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace s7200::tools {

std::string lower_case(std::string_view text);

/// The words with a blank between them.
std::string joined(const std::vector<std::string>& words);

/// `break expects a line number`
std::string expects(std::string_view command, std::string_view what);

}  // namespace s7200::tools
