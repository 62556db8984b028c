// What `bench` measures besides a slave, as files: to measure whole processes with them.
#pragma once

#include <string>

namespace s7200::tools {

/// Writes all of them to a folder, which is made if need be, in one that is there; none if one is there already. Returns the
/// exit code, after a message if it is not kFine.
int save_programs(const std::string& folder);

}  // namespace s7200::tools
