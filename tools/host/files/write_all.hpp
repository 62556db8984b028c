// Writing to a descriptor, whatever it is set to.
#pragma once

#include <string_view>

namespace s7200::tools {

/// Writes all bytes. Returns 0 or the error. After an interruption a reader that takes nothing for 5 s is given up.
int write_all(int fd, std::string_view bytes);

}  // namespace s7200::tools
