// How often loops run at most, as `s7200 inspect --loop LINE=N` says.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/views/inspection/inspection.hpp"

namespace s7200::tools {

/// `texts`: `445=8`, the line of a FOR or of a JMP back and how often its loop runs. Nothing, and `why`, if one cannot be
/// read, no loop is there, or the view makes no use of it.
std::optional<StatedLoops> stated_loops(const Program& program, std::string_view view, const std::vector<std::string>& texts,
                                        std::string& why);

}  // namespace s7200::tools
