#include "interpreter/analysis/steps.hpp"

#include <algorithm>
#include <map>

#include "interpreter/base/text/among.hpp"
#include "interpreter/program/loading/unread.hpp"

namespace s7200 {
namespace {

Structure structure_of_step(const Op& op) { return op.instruction->structure; }

Bits step_bit_of(const Operand& operand) { return {operand.at * 8u + operand.bit, 1}; }

class StepFinder {
 public:
  explicit StepFinder(const Facts& facts) : facts_(facts) {}

  std::vector<Step> all() {
    for (const Op& op : facts_.program.ops) note(op);
    std::optional<Bits> inside;
    for (std::uint32_t op = 0; op < facts_.program.ops.size(); ++op) {
      const Op& now = facts_.program.ops[op];
      if (structure_of_step(now) == Structure::SegmentBegin) inside = begin(op);
      if (structure_of_step(now) == Structure::SegmentEnd) inside.reset();
      if (inside) add_action(steps_[inside->first], op);
      for (auto& [first, step] : steps_) add(step, op, inside && inside->first == first);
    }
    std::vector<Step> result;
    for (auto& [first, step] : steps_) result.push_back(std::move(step));
    return result;
  }

 private:
  void note(const Op& op) {
    const bool names_one =
        structure_of_step(op) == Structure::SegmentBegin || structure_of_step(op) == Structure::SegmentTransition;
    if (!names_one || op[0].unread()) return;
    const Bits bit = step_bit_of(op[0]);
    steps_[bit.first].bit = bit;
  }

  std::optional<Bits> begin(std::uint32_t op) {
    const Op& segment = facts_.program.ops[op];
    if (segment[0].unread()) return {};
    steps_[step_bit_of(segment[0]).first].segment = op;
    return step_bit_of(segment[0]);
  }

  void add_action(Step& step, std::uint32_t op) const {
    const Op& now = facts_.program.ops[op];
    const bool acts = structure_of_step(now) == Structure::None || structure_of_step(now) == Structure::Call ||
                      structure_of_step(now) == Structure::Attach;
    if (acts && !now.is_contact && !is_unread(now)) step.actions.push_back(op);
  }

  void add(Step& step, std::uint32_t op, bool inside) const {
    const Op& now = facts_.program.ops[op];
    if (is_unread(now) || structure_of_step(now) == Structure::SegmentBegin) return;
    if (structure_of_step(now) == Structure::SegmentTransition) {
      if (target_of_transition(now) == step.bit) step.switched_on.push_back(op);
      if (inside) step.transitions.push_back(op);
      return;
    }
    bool reads = false, writes = false;
    for (const MemoryAccess& access : facts_.effects[op]) {
      if (access.by_pointer || !access.bits.overlaps(step.bit)) continue;
      reads |= access.reads();
      writes |= access.writes();
    }
    if (reads && now.is_contact && !inside) step.looked_at.push_back(op);
    if (writes) list_of(step, now.instruction->mnemonic).push_back(op);
  }

  static std::vector<std::uint32_t>& list_of(Step& step, std::string_view mnemonic) {
    if (is_among(mnemonic, {"=", "S"})) return step.switched_on;
    return mnemonic == "R" ? step.switched_off : step.written;
  }

  const Facts& facts_;
  std::map<std::uint64_t, Step> steps_{};  // by bit
};

}  // namespace

std::vector<Step> steps_of(const Facts& facts) { return StepFinder(facts).all(); }

Bits target_of_transition(const Op& transition) { return step_bit_of(transition[0]); }

}  // namespace s7200
