// What is to be forced and released, as people write it, and what is forced.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "interpreter/base/result.hpp"
#include "interpreter/cpu/cpu.hpp"
#include "tools/session/past/actions/action.hpp"

namespace s7200::tools {

/// `VW10=5`, `I0.3=1`; trouble if one of them cannot be forced.
Result<Force> force_of(const std::vector<std::string>& assignments, const Cpu& cpu);

/// `VW10`, or `all`; trouble if one of them is not forced.
Result<Unforce> unforce_of(const std::vector<std::string>& places, const Cpu& cpu);

/// Whether the field drives it: input points, analog inputs, the potentiometers, the mode switch.
bool is_from_field(const MemoryRange& place);

/// What is wrong with setting that place; empty if it may be set.
std::string not_settable(const MemoryRange& place);

struct Forced {
  MemoryRange place;
  std::string value;  ///< `1`, `16#0005 (5)`
};
std::vector<Forced> forced_in(const Cpu& cpu);

}  // namespace s7200::tools
