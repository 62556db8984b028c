#include "interpreter/cpu/local_memory.hpp"

#include <algorithm>

namespace s7200::local_memory {
namespace {

constexpr std::size_t kOfInterrupts = 9;  // after the main program and eight levels of subroutines

}  // namespace

std::size_t level(const State& s) {
  return s.in_interrupt ? kOfInterrupts + s.call_depth - s.saved.call_depth : s.call_depth;
}

void put_aside(Core& core) {
  if (!core.program().uses_local_memory) return;
  LocalMemory& kept = core.s.local[level(core.s)];
  std::copy_n(core.s.image.begin() + image::kL, kept.size(), kept.begin());
}

void take_up(Core& core) {
  if (!core.program().uses_local_memory) return;
  const LocalMemory& kept = core.s.local[level(core.s)];
  std::copy(kept.begin(), kept.end(), core.s.image.begin() + image::kL);
}

}  // namespace s7200::local_memory
