// Names that files can have.
#pragma once

#include <string>

namespace s7200::tools {

/// Why no file can have this name, whatever there is; empty if one can. Windows keeps some names for devices.
std::string why_no_name_of_a_file(const std::string& path);

}  // namespace s7200::tools
