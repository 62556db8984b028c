// What keeps a system from writing a file, whatever our rule says.
#pragma once

#include <string>

namespace s7200::tools {

/// Why nothing can be written under this name; empty if it can. Windows keeps some names for devices, a program may have a
/// file for itself alone, and one that is write-protected is not replaced.
std::string why_not_to_be_written(const std::string& path);

}  // namespace s7200::tools
