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

std::vector<OpenRoutine> open_routines(const Program& program, const State& s) {
  std::vector<OpenRoutine> open{{.first = 0, .call = {}, .memory = s.local[0]}};
  const std::uint8_t before = s.in_interrupt ? s.saved.call_depth : s.call_depth;
  const auto enter = [&](std::uint8_t depth, std::size_t level) {
    const std::uint32_t call = s.calls[depth].return_to - 1;
    open.push_back({.first = program.ops[call].target, .call = call, .memory = s.local[level]});
  };
  for (std::uint8_t depth = 0; depth < before; ++depth) enter(depth, depth + std::size_t{1});
  if (s.in_interrupt)
    open.push_back({.first = program.interrupt[s.serving_routine], .call = {}, .memory = s.local[kOfInterrupts]});
  for (std::uint8_t depth = before; depth < s.call_depth; ++depth) enter(depth, kOfInterrupts + 1 + depth - before);
  open.back().runs = true;
  open.back().memory = std::span(s.image).subspan<image::kL, std::tuple_size_v<LocalMemory>>();
  return open;
}

}  // namespace s7200::local_memory
