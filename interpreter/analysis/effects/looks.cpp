#include "interpreter/analysis/effects/looks.hpp"

#include <algorithm>
#include <utility>

#include "interpreter/analysis/effects/effects.hpp"

namespace s7200 {
namespace {

/// SM0.4 and SM0.5.
constexpr Bits kClockBits{std::uint64_t{sm::kScanStatus} * 8 + 4, 2};
static_assert(sm::kClock1min == 1 << 4 && sm::kClock1s == 1 << 5);

/// The numbers of the elements of which some bit is among `bits`; `first`: bit 0 of element 0. From, until before.
std::pair<std::uint64_t, std::uint64_t> elements_in(const Bits& bits, std::uint64_t first, std::uint64_t size,
                                                    std::uint64_t elements) {
  const std::uint64_t end = first + size * elements;
  if (!bits.overlaps({first, size * elements})) return {0, 0};
  return {(std::max(bits.first, first) - first) / size, (std::min(bits.end(), end) - first + size - 1) / size};
}

class Finder {
 public:
  explicit Finder(const Program& program) : program_(program) {}

  Looks find() {
    for (std::uint32_t op = 0; op < program_.ops.size(); ++op) look_at(op);
    return looks_;
  }

 private:
  void look_at(std::uint32_t number) {
    const Op& op = program_.ops[number];
    const Instruction& instruction = *op.instruction;
    looks_.time_of_day |= instruction.effect == Effect::ReadsTimeOfDay;
    looks_.every_scan |= instruction.effect == Effect::ReadsMilliseconds;
    may_branch_ |= branches(instruction);
    const bool is_timer = instruction.hidden == Hidden::Number && op[0].at < image::kC;
    if (is_timer) executed(op[2].at);
    for (const MemoryAccess& access : effects_of(program_, number, pointers_)) {
      const bool its_own = is_timer && (access.operand == 0 || access.operand == kNoOperand);
      if (!its_own) note(access);
    }
  }

  /// Whether some of what follows may be left out in a scan, or done twice.
  static bool branches(const Instruction& instruction) {
    switch (instruction.structure) {
      case Structure::Jump:
      case Structure::Label:  // a jump back to it may follow
      case Structure::For:
      case Structure::SegmentExit:
      case Structure::MainEnd:
        return true;
      default:
        return instruction.effect == Effect::ConditionalEnd;
    }
  }

  /// By its TON, TONR or TOF.
  void executed(std::uint32_t timer) {
    if (may_branch_ || seen_.test(timer)) looks_.every_tick.set(timer);
    seen_.set(timer);
  }

  void note(const MemoryAccess& access) {
    looks_.clock_bits |= access.reads() && access.bits.overlaps(kClockBits);
    every_tick(elements_in(access.bits, std::uint64_t{image::kT} * 8, 16, image::kTimers));
    if (access.writes()) every_tick(elements_in(access.bits, std::uint64_t{image::kTBits} * 8, 1, image::kTimers));
  }

  void every_tick(const std::pair<std::uint64_t, std::uint64_t>& timers) {
    for (std::uint64_t timer = timers.first; timer < timers.second; ++timer) looks_.every_tick.set(timer);
  }

  const Program& program_;
  Pointers pointers_ = Pointers::nothing_known(program_);  // whoever sets one later must not change what is looked at
  Looks looks_;
  std::bitset<image::kTimers> seen_;  // executed so far
  bool may_branch_ = false;           // somewhere before
};

}  // namespace

std::shared_ptr<const Program> with_every_scan(const Program& program) {
  const auto same = std::make_shared<Program>(program);
  same->looks.every_scan = true;
  return same;
}

Looks looks_of(const Program& program) { return Finder(program).find(); }

}  // namespace s7200
