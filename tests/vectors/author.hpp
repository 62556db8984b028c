// Writes vectors: a case says what to execute and on what; the reference model says what the result is.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tests/reference_model/machine.hpp"
#include "tests/vectors/vector_file.hpp"

namespace s7200::vectors {

struct Case {
  std::string title;
  std::vector<std::string> ops;
  std::vector<std::string> before;  ///< assignments
  Levels stack{true};
  std::uint32_t steps = 1;
  std::int64_t until = 0;  ///< ns since power-up, instead of steps: up to the first instruction that ends there or later
  std::uint8_t flags = 0;  ///< bits of SM1 that the instruction sets and resets: each starts opposite to its result
};

/// The complete vector, on a CPU that the reference model can be.
Vector execute(const Case& what, const std::string& source, const std::string& cpu);

/// Values of the assignments as they are in the reference model's memory.
void assign(reference::Memory& memory, const Assignment& assignment);

}  // namespace s7200::vectors
