// Pointers that point nowhere.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "interpreter/cpu/cpu.hpp"
#include "interpreter/program/operands/address.hpp"

namespace s7200::tools {

/// Those of an instruction that the CPU cannot follow now.
std::vector<MemoryRange> bad_pointers(const Cpu& cpu, std::uint32_t op);

/// `*VD10: VD10 is 16#7F000000, which points nowhere`; `address`: what the pointer is called.
std::string bad_pointer_text(const Cpu& cpu, const MemoryRange& pointer, std::string_view name, std::string_view address);

}  // namespace s7200::tools
