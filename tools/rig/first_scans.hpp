// Runs a system until it can answer a master.
#pragma once

#include "tools/rig/rig.hpp"

namespace s7200::tools {

/// Runs several PLCs until each has ended its first scan, in which programs set up their ports, or is in STOP or off. One
/// PLC is left where it is. Returns false if that has not come by `limit`, or a stop was asked for.
bool run_first_scans(Rig& rig, Time limit);

}  // namespace s7200::tools
