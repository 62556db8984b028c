// How often loops run at most, as `s7200 inspect --loop LINE=N` says.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/result.hpp"
#include "tools/views/inspection/inspection.hpp"

namespace s7200::tools {

/// `texts`: `445=8`, the line of a FOR or of a JMP back and how often its loop runs. Trouble if one cannot be
/// read, no loop is there, or the view makes no use of it.
Result<StatedLoops> stated_loops(const Program& program, std::string_view view, const std::vector<std::string>& texts);

}  // namespace s7200::tools
