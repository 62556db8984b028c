#include "interpreter/program/looks.hpp"

#include <algorithm>

#include "interpreter/program/program.hpp"

namespace s7200 {
namespace {

/// ImageBytes of the image, from `from` until before `to`.
struct ImageBytes {
  std::uint32_t from, to;

  bool contain(std::uint32_t at) const { return at >= from && at < to; }
};

constexpr ImageBytes kElementValues{image::kT, image::kC}, kElementBits{image::kTBits, image::kCBits};

class Finder {
 public:
  explicit Finder(const Program& program) : program_(program) {}

  Looks find() {
    for (std::uint32_t op = 0; op < program_.ops.size(); ++op) look_at(op);
    for (const Parameter& parameter : program_.parameters)
      operand(parameter.actual, parameter.role, parameter.width == Width::Bit, false);
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
      operand(op[k], rules[k].role, rules[k].width == Width::Bit, begins_block(rules[k]));
    }
  }

  /// What is read and cannot be a constant is a table or a message: its first element says how far it goes.
  static bool begins_block(const OperandRule& rule) {
    return rule.counted != 0 || rule.elements != 1 || (rule.role == Role::In && rule.width != Width::Bit && !rule.constant);
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

  /// Every pointer reaches the values of timers, and on late CPUs 22x special memory. SMB0 is never written by a program.
  void operand(const Operand& operand, Role role, bool is_bit, bool is_block) {
    if (operand.pointer) {
      looks_.clock_bits |= program_.model->pointer_code(Area::SM).has_value();
      looks_.every_tick.set();
      return;
    }
    if (operand.at == sm::kScanStatus) looks_.clock_bits |= !is_bit || is_clock_bit(operand);
    if (kElementValues.contain(operand.at)) every_tick((operand.at - kElementValues.from) / 2, is_block);
    if (role != Role::In && kElementBits.contain(operand.at))
      every_tick((operand.at - kElementBits.from) * 8 + operand.bit, is_block);
  }

  /// Of one timer or, in a block, of all from there on.
  void every_tick(std::uint32_t first, bool is_block) {
    const std::uint32_t end = is_block ? image::kTimers : first + 1;
    for (std::uint32_t timer = first; timer < end; ++timer) looks_.every_tick.set(timer);
  }

  static bool is_clock_bit(const Operand& operand) { return (1u << operand.bit) & (sm::kClock1min | sm::kClock1s); }

  const Program& program_;
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
