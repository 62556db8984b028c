// References to memory and to instructions, as messages carry them. Memory is referred to by an area or an address as in
// STL, `V`, `VB100`, or by a number: where it is among all areas. Instructions have numbers above those.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "interpreter/program/program.hpp"

namespace s7200::tools::dap {

/// A place in an area that this CPU has. An offset may lead out of it.
struct MemoryPlace {
  std::uint32_t at = 0;              ///< in the image
  std::uint32_t begin = 0, end = 0;  ///< of its area, in the image
};

/// Nothing for what this CPU has not.
std::optional<MemoryPlace> find_memory(std::string_view reference, const Program& program);

std::string instruction_reference(std::int64_t op);
std::optional<std::int64_t> find_instruction_number(std::string_view reference);

/// `0x00000ABC`
std::string address_text(std::int64_t address);

}  // namespace s7200::tools::dap
