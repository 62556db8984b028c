#include "interpreter/program/looks.hpp"

#include <algorithm>

#include "interpreter/program/program.hpp"

namespace s7200 {
namespace {

/// Bytes of the image, from `from` until before `to`.
struct Bytes {
  std::uint32_t from = 0, to = 0;

  bool overlap(const Bytes& other) const { return from < other.to && other.from < to; }
};

constexpr Bytes kScanStatus{sm::kScanStatus, sm::kScanStatus + 1};
constexpr std::uint32_t kTimers = 256;
constexpr Bytes value_of(std::uint32_t timer) { return {image::kT + 2 * timer, image::kT + 2 * timer + 2}; }
constexpr Bytes bit_of(std::uint32_t timer) { return {image::kTBits + timer / 8, image::kTBits + timer / 8 + 1}; }

class Finder {
 public:
  explicit Finder(const Program& program) : program_(program) {}

  Looks find() {
    for (std::uint32_t op = 0; op < program_.ops.size(); ++op) look_at(op);
    for (const Parameter& parameter : program_.parameters)
      operand(parameter.actual, parameter.role, parameter.width == Width::Bit, reach_of(parameter.actual, false));
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
    const auto rules = instruction.rules();
    for (std::size_t k = is_timer ? 1 : 0; k < rules.size(); ++k) {
      if (rules[k].kind != OperandKind::Memory) continue;
      const bool counted = rules[k].counted != 0 || rules[k].elements != 1 || rules[k].text;
      operand(op[k], rules[k].role, rules[k].width == Width::Bit, reach_of(op[k], counted));
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

  /// What an operand reaches: its own bytes or, if a count says how far it goes, all of its area from there on.
  Bytes reach_of(const Operand& operand, bool counted) const {
    return {operand.at, counted ? end_of_area(operand.at) : operand.at + operand.width};
  }

  std::uint32_t end_of_area(std::uint32_t at) const {
    for (const AreaInfo& area : all_areas()) {
      const std::uint32_t size = program_.model->size_of(area.area);
      const std::uint32_t end = area.base + size * std::max(1u, area.element), end_of_bits = area.bits + (size + 7) / 8;
      if (at >= area.base && at < end) return end;
      if (area.element && area.bits != kNoBits && at >= area.bits && at < end_of_bits) return end_of_bits;
    }
    return image::kSize;
  }

  void operand(const Operand& operand, Role role, bool is_bit, Bytes bytes) {
    if (operand.pointer) return through_pointer();
    if (role != Role::Out && bytes.overlap(kScanStatus)) looks_.clock_bits |= !is_bit || is_clock_bit(operand);
    for (std::uint32_t timer = 0; timer < kTimers; ++timer)
      if (bytes.overlap(value_of(timer)) || (role != Role::In && bytes.overlap(bit_of(timer)))) looks_.every_tick.set(timer);
  }

  static bool is_clock_bit(const Operand& operand) { return (1u << operand.bit) & (sm::kClock1min | sm::kClock1s); }

  void through_pointer() {
    for (const Reach& reach : program_.reach) {
      if (reach.size == 0) continue;
      const Bytes bytes{reach.base, reach.base + reach.size};
      looks_.clock_bits |= bytes.overlap(kScanStatus);
      if (bytes.overlap(value_of(0))) looks_.every_tick.set();
    }
  }

  const Program& program_;
  Looks looks_;
  std::bitset<kTimers> seen_;  // executed so far
  bool may_branch_ = false;    // somewhere before
};

}  // namespace

std::shared_ptr<const Program> with_every_scan(const Program& program) {
  const auto same = std::make_shared<Program>(program);
  same->looks.every_scan = true;
  return same;
}

Looks looks_of(const Program& program) { return Finder(program).find(); }

}  // namespace s7200
