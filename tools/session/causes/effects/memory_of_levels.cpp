#include "tools/session/causes/effects/memory_of_levels.hpp"

#include <algorithm>

#include "interpreter/cpu/local_memory.hpp"
#include "interpreter/model/area.hpp"
#include "interpreter/model/special_memory.hpp"

namespace s7200::tools {
namespace {

constexpr Bits kLocal{std::uint64_t{image::kL} * 8, sizeof(LocalMemory) * 8};
constexpr Bits kAccumulators{std::uint64_t{image::kAC} * 8, sizeof(SavedContext::accumulators) * 8};
constexpr Bits kFlagBits{std::uint64_t{sm::kFlags} * 8, 8};

}  // namespace

MemoryOfLevels::MemoryOfLevels(const Cpu& cpu, std::vector<std::uint8_t>& seen, PointSamples& samples)
    : cpu_(cpu),
      seen_(seen),
      samples_(samples),
      level_(local_memory::level(cpu.state())),
      in_interrupt_(cpu.state().in_interrupt) {
  const State& state = cpu.state();
  for (std::size_t level = 0; level < local_.size(); ++level)
    local_[level] = {{state.local[level].begin(), state.local[level].end()}, std::vector<std::size_t>(kLocal.count)};
  const auto& accumulators = state.saved.accumulators;
  accumulators_ = {{accumulators.begin(), accumulators.end()}, std::vector<std::size_t>(kAccumulators.count)};
  flags_ = {{state.saved.smb1}, std::vector<std::size_t>(kFlagBits.count)};
}

MemoryOfLevels::Kept MemoryOfLevels::kept(const Bits& place) const {
  const auto first = seen_.begin() + static_cast<std::ptrdiff_t>(place.first / 8);
  return {{first, first + static_cast<std::ptrdiff_t>(place.count / 8)}, samples_.last_changes(place)};
}

void MemoryOfLevels::restore(const Bits& place, const Kept& kept) {
  std::ranges::copy(kept.bytes, seen_.begin() + static_cast<std::ptrdiff_t>(place.first / 8));
  samples_.set_last_changes(place, kept.changes);
}

void MemoryOfLevels::follow() {
  const State& state = cpu_.state();
  const std::size_t level = local_memory::level(state);
  if (level == level_) return;
  if (cpu_.program().uses_local_memory) {
    local_[level_] = kept(kLocal);
    restore(kLocal, local_[level]);
  }
  if (state.in_interrupt && !in_interrupt_) {
    accumulators_ = kept(kAccumulators);
    flags_ = kept(kFlagBits);
  } else if (!state.in_interrupt && in_interrupt_) {
    restore(kAccumulators, accumulators_);
    restore(kFlagBits, flags_);
  }
  level_ = level;
  in_interrupt_ = state.in_interrupt;
}

}  // namespace s7200::tools
