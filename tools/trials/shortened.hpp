// What a trial comes down to.
#pragma once

#include <functional>

#include "tools/trials/trial.hpp"

namespace s7200::tools {

/// The shortest trial near this one for which `holds`, which it does for `trial`: stimuli are left out, frames cut, waits
/// and values made simple, one after the other. `holds` is asked at most `most` times.
Trial shortened(Trial trial, const std::function<bool(const Trial&)>& holds, std::size_t most);

}  // namespace s7200::tools
