// Random numbers that nobody can guess.
#pragma once

#include <span>

namespace s7200::tools {

/// Throws std::runtime_error if the system has none.
void fill_with_random_bytes(std::span<unsigned char> bytes);

}  // namespace s7200::tools
