// RUN and STOP in the words of the command `mode`.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "interpreter/base/result.hpp"
#include "tools/session/past/actions/action.hpp"

namespace s7200::tools {

/// What `run` or `stop` asks of a CPU with power. Trouble for other words, and where the CPU cannot
/// go there.
Result<SetMode> mode_of(std::string_view word, const serial::Simulation& simulation);

}  // namespace s7200::tools
