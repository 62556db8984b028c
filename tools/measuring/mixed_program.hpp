// A program of a wanted length, for measuring: networks as people write them.
#pragma once

#include <cstdint>
#include <string>

namespace s7200::tools {

/// A program of `instructions` instructions, always the same for a number: contacts, now and then a comparison or a branch,
/// and then a coil or a box. It is for a CPU 226XM, which has room for 4000.
std::string mixed_program(std::uint32_t instructions);

}  // namespace s7200::tools
