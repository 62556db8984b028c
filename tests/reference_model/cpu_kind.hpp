// What differs between the CPUs that the reference model can be (facts 1.1, 1.2, 6.6, 10.1).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "tests/reference_model/times.hpp"

namespace s7200::reference {

struct CpuKind {
  std::string name;
  std::size_t points, V, SM, S, analog, timers, L, HC;  ///< bytes; timers, and as many counters
  std::uint8_t identification;
  std::int64_t watchdog;  ///< ns
  bool keeps_operands;    ///< of +I, -I, +D, -D and DIV if the result does not fit
  const Times* times;
};

/// `214` or `224`. Throws for any other.
const CpuKind& cpu_kind(const std::string& name);

}  // namespace s7200::reference
