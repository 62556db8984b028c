// A listing of a wanted length, for measuring how long files are checked.
#pragma once

#include <cstdint>
#include <string>

namespace s7200::tools {

/// A listing of `lines` lines, six at least, always the same for a number: networks with titles, comments and statements as
/// people write them. From some thousand lines on it is larger than any CPU's program memory, which is its only mistake.
std::string long_listing(std::uint32_t lines);

}  // namespace s7200::tools
