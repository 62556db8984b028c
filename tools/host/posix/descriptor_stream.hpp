// An InputStream of a descriptor, which it does not own.
#pragma once

#include "tools/host/files/input_stream.hpp"

namespace s7200::tools {

/// As InputStream::read().
InputStream::Reading read_descriptor(int fd, std::span<char> into, std::chrono::milliseconds at_most);

}  // namespace s7200::tools
