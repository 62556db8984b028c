#include "interpreter/cpu/idle/footprint.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "interpreter/analysis/effects/effects.hpp"
#include "interpreter/model/memory_alone.hpp"

namespace s7200 {
namespace {

constexpr std::uint32_t kBytes = 8;  // looked at together

/// The bits of the timers: whoever resets one also stops its timer.
constexpr Bits kTimerBits{std::uint64_t{image::kTBits} * 8, image::kTimers};

std::uint64_t eight_bytes(const std::uint8_t* from) {
  std::uint64_t bytes = 0;
  std::memcpy(&bytes, from, kBytes);
  return bytes;
}

bool is_timer(const Op& op) { return op[0].at < image::kC; }

}  // namespace

Footprint::Footprint() : bits_(image::kSize) {}

bool Footprint::add_next(const Core& core) {
  const State& s = core.s;
  const Op& op = core.program().ops[s.pc];
  if (op.power_mask & ~s.stack.bits()) return true;
  const bool has_number = op.instruction->hidden == Hidden::Number;
  if (has_number ? !add_number(op) : !works_on_memory_alone(*op.instruction)) return false;
  if (op.instruction->structure == Structure::Call) calls_ = std::max<std::size_t>(calls_, s.call_depth + 1u);
  for (const MemoryAccess& access : effects_now(core.program(), s.pc, s.image)) {
    if (!has_number && access.writes() && access.bits.overlaps(kTimerBits)) return false;
    add(access.bits);
    if (access.writes()) changed_.push_back(access.bits);
  }
  return true;
}

/// A timer that is executed twice may count in between and look off at the end.
bool Footprint::add_number(const Op& op) {
  std::vector<std::uint8_t>& those = is_timer(op) ? timers_ : counters_;
  const auto number = static_cast<std::uint8_t>(op[2].at);
  const bool known = std::ranges::find(those, number) != those.end();
  if (!known) those.push_back(number);
  return !(known && is_timer(op));
}

bool Footprint::unchanged(const State& before, const State& now) {
  std::erase_if(changed_, [&](const Bits& bits) {
    const std::uint64_t first = bits.first / 8, end = (bits.end() + 7) / 8;
    return std::memcmp(&before.image[first], &now.image[first], end - first) == 0;
  });
  return changed_.empty() && same_besides_memory(before, now, calls_ + 1);
}

void Footprint::add(const Bits& bits) {
  for (std::uint64_t bit = bits.first; bit < bits.end(); ++bit) bits_[bit / 8] |= static_cast<std::uint8_t>(1u << bit % 8);
}

bool Footprint::has(std::uint32_t at, std::uint32_t count, std::uint8_t bits) const {
  return std::any_of(bits_.begin() + at, bits_.begin() + at + count, [bits](std::uint8_t own) { return (own & bits) != 0; });
}

void Footprint::complete(const Program& program) {
  has_clock_bits_ = has(sm::kScanStatus, 1, sm::kClock1min | sm::kClock1s);
  has_scan_values_ =
      has(sm::kScanStatus, 1, sm::kAlternatingScan) || has(sm::kLastScan, sm::kLongestScan + 2 - sm::kLastScan);
  if (program.uses_local_memory) {
    levels_ = calls_ + 1;
    add({std::uint64_t{image::kL} * 8, sizeof(LocalMemory) * 8});
  }
  for (std::uint32_t at = 0; at < image::kSize; at += kBytes)
    if (const std::uint64_t mask = eight_bytes(&bits_[at])) memory_.push_back({at, mask});
  bits_.clear();
  changed_.clear();
}

bool Footprint::same_in(const State& a, const State& b) const {
  const auto same = [&](const Bytes& each) {
    return ((eight_bytes(&a.image[each.at]) ^ eight_bytes(&b.image[each.at])) & each.mask) == 0;
  };
  return std::ranges::all_of(memory_, same) && same_besides_memory(a, b, levels_);
}

bool Footprint::same_besides_memory(const State& a, const State& b, std::size_t levels) const {
  return std::ranges::all_of(timers_, [&](std::uint8_t each) { return a.timer[each] == b.timer[each]; }) &&
         std::ranges::all_of(counters_,
                             [&](std::uint8_t each) { return a.counter_inputs[each] == b.counter_inputs[each]; }) &&
         std::equal(a.calls.begin(), a.calls.begin() + calls_, b.calls.begin()) &&
         std::equal(a.local.begin(), a.local.begin() + levels, b.local.begin());
}

}  // namespace s7200
