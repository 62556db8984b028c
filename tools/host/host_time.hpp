// The host's clock.
#pragma once

#include "interpreter/base/time.hpp"

namespace s7200::tools {

/// Nanoseconds of a host clock that is never set.
Time host_time();

}  // namespace s7200::tools
