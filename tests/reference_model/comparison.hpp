// State of the reference model against state of the interpreter.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "interpreter/cpu/cpu.hpp"
#include "tests/reference_model/machine.hpp"

namespace s7200::reference {

/// An area of the reference model and where the interpreter keeps it in its image.
struct AreaPair {
  Bytes Memory::*bytes;
  std::uint32_t base;
  std::string_view name;
};
extern const std::array<AreaPair, 17> kAreaPairs;

/// Gives the interpreter the memory of the reference model, as a programming device would.
void copy_to(Cpu& cpu, const Memory& memory);

/// What differs, one line for each difference; empty if nothing does.
std::string compare(const Machine& machine, const Cpu& cpu);

}  // namespace s7200::reference
