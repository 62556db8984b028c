#include "interpreter/cpu/local_memory.hpp"

#include <algorithm>

namespace s7200::local_memory {
namespace {

constexpr std::size_t kOfInterrupts = 9;  // after the main program and eight levels of subroutines

LocalMemory& current(State& s) {
  const std::size_t level = s.in_interrupt ? kOfInterrupts + s.call_depth - s.saved.call_depth : s.call_depth;
  return s.local[level];
}

}  // namespace

void put_aside(Core& core) {
  if (!core.program().uses_local_memory) return;
  LocalMemory& kept = current(core.s);
  std::copy_n(core.s.image.begin() + image::kL, kept.size(), kept.begin());
}

void take_up(Core& core) {
  if (!core.program().uses_local_memory) return;
  const LocalMemory& kept = current(core.s);
  std::copy(kept.begin(), kept.end(), core.s.image.begin() + image::kL);
}

}  // namespace s7200::local_memory
