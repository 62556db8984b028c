// RUN and STOP in the words of the command `mode`.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "tools/session/past/actions/action.hpp"

namespace s7200::tools {

/// What `run` or `stop` asks of a CPU with power. Returns nothing and sets `why` for other words, and where the CPU cannot
/// go there.
std::optional<SetMode> mode_of(std::string_view word, const serial::Simulation& simulation, std::string& why);

}  // namespace s7200::tools
