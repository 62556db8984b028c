#include "interpreter/analysis/lint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "interpreter/analysis/lint_ops.hpp"
#include "interpreter/program/operands.hpp"
#include "interpreter/program/warnings.hpp"

namespace s7200 {
namespace {

using namespace lint;

// --- the paths through the program ---

/// Ops in a row, from `from` until before `to`.
struct Stretch {
  std::uint32_t from = 0, to = 0;
};

/// The paths through the routines of a program.
class Flow {
 public:
  explicit Flow(const Program& program) : program_(program), count_(static_cast<std::uint32_t>(program.ops.size())) {
    bool on = false, in_segment = false;  // in a segment, power flow is never certain
    std::uint32_t head = 0;
    for (std::uint32_t i = 0; i < count_; ++i) {
      if (is_head(i)) head = i;
      if (structure(i) == Structure::SegmentBegin) in_segment = true;
      if (structure(i) == Structure::SegmentEnd) in_segment = false;
      head_.push_back(head);
      on_.push_back(on);
      on = !in_segment && on_after(i, on);
      ways_.push_back(ways_from(i));
    }
    find_straights();
    find_necessary();
  }

  /// The head of an op's routine; 0 for the main program.
  std::uint32_t head(std::uint32_t op) const { return head_[op]; }
  bool in_interrupt(std::uint32_t op) const { return structure(head_[op]) == Structure::InterruptHead; }

  /// Whether both belong to the same routine and it never ends between the first and the second.
  bool leads_to(std::uint32_t first, std::uint32_t second) const {
    return head_[first] == head_[second] && first != second && necessary(second, first);
  }

  /// The ops that may be executed between the first and the second.
  std::vector<Stretch> between(std::uint32_t first, std::uint32_t second) const {
    std::vector<bool> seen(straight_end_.size());
    std::vector<Stretch> found;
    std::vector<std::uint32_t> open = ways_[first].to;
    while (!open.empty()) {
      const std::uint32_t from = open.back(), straight = straight_[from], end = straight_end_[straight];
      open.pop_back();
      if (seen[straight]) continue;
      seen[straight] = is_straight_begin(from);
      const bool ends_there = from <= second && second < end;
      found.push_back({from, ends_there ? second : end});
      if (!ends_there) open.insert(open.end(), ways_[end - 1].to.begin(), ways_[end - 1].to.end());
    }
    return found;
  }

  /// The interrupt routines.
  std::vector<Stretch> interrupts() const {
    std::vector<Stretch> found;
    for (std::uint32_t i = 0; i < count_; ++i) {
      if (!in_interrupt(i)) continue;
      if (found.empty() || found.back().to != i) found.push_back({i, i});
      ++found.back().to;
    }
    return found;
  }

  /// Whether every scan executes it.
  bool in_every_scan(std::uint32_t op) { return necessary(op, head_[op]) && routine_in_every_scan(head_[op]); }

 private:
  struct Ways {
    std::vector<std::uint32_t> to;
    bool end = false;  // of the routine or the scan
  };

  Structure structure(std::uint32_t op) const { return program_.ops[op].instruction->structure; }
  bool is_head(std::uint32_t op) const {
    return structure(op) == Structure::SubroutineHead || structure(op) == Structure::InterruptHead;
  }

  /// Whether the top of the logic stack is known to be 1 after an instruction.
  bool on_after(std::uint32_t i, bool before) const {
    const Op& op = program_.ops[i];
    const Instruction& instruction = *op.instruction;
    if (is_head(i)) return true;
    if (instruction.effect == Effect::LoadsBit) return op[0].at == image::kSM && op[0].bit == 0;
    if (instruction.structure == Structure::Jump) return false;
    return before && (instruction.rung.needs_power_flow || instruction.effect == Effect::Coil ||
                      instruction.structure == Structure::Label);
  }

  Ways ways_from(std::uint32_t i) const {
    const Op& op = program_.ops[i];
    switch (op.instruction->structure) {
      case Structure::MainEnd:
      case Structure::SubroutineEnd:
      case Structure::InterruptEnd:
        return {{}, true};
      case Structure::Jump:
        return on_[i] ? Ways{{op.target}, false} : Ways{{i + 1, op.target}, false};
      case Structure::For:
      case Structure::Next:
        return {{i + 1, op.target}, false};
      default:
        break;
    }
    if (op.instruction->effect != Effect::ConditionalEnd) return {{i + 1}, false};
    return on_[i] ? Ways{{}, true} : Ways{{i + 1}, true};
  }

  bool is_straight_begin(std::uint32_t op) const { return op == 0 || straight_[op - 1] != straight_[op]; }

  /// Ops of which each leads to the next one and nowhere else, and nothing leads into their middle.
  void find_straights() {
    std::vector<bool> begins(count_ + 1);
    for (std::uint32_t i = 0; i < count_; ++i) {
      const bool goes_on = !ways_[i].end && ways_[i].to.size() == 1 && ways_[i].to.front() == i + 1;
      if (goes_on) continue;
      begins[i + 1] = true;
      for (const std::uint32_t next : ways_[i].to) begins[next] = true;
    }
    for (std::uint32_t i = 0; i < count_; ++i) {
      if (i == 0 || begins[i]) straight_end_.push_back(i);
      straight_.push_back(static_cast<std::uint32_t>(straight_end_.size() - 1));
      straight_end_.back() = i + 1;
    }
  }

  /// Whether no way from `op` to the end of its routine leads around `other`; each op is on its own ways.
  bool necessary(std::uint32_t other, std::uint32_t op) const {
    return !ends_[op] || (ends_[other] && span_[other].first <= span_[op].first && span_[op].second <= span_[other].second);
  }

  /// The tree of post-dominators (Cooper, Harvey, Kennedy, "A Simple, Fast Dominance Algorithm", 2001): the parent of an op
  /// is the next one that all its ways to the end have in common, `count_` the end of all routines.
  void find_necessary() {
    constexpr std::uint32_t kUnknown = 0xFFFF'FFFF;
    const std::vector<std::uint32_t> order = from_the_end();
    std::vector<std::uint32_t> parent(count_ + 1, kUnknown), rank(count_ + 1, 0);
    for (std::uint32_t i = 0; i < order.size(); ++i) rank[order[i]] = i;
    parent[count_] = count_;
    const auto meet = [&](std::uint32_t a, std::uint32_t b) {
      while (a != b) (rank[a] > rank[b] ? a : b) = parent[rank[a] > rank[b] ? a : b];
      return a;
    };
    for (bool changed = true; changed;) {
      changed = false;
      for (const std::uint32_t op : std::span(order).subspan(1)) {
        std::uint32_t common = ways_[op].end ? count_ : kUnknown;
        for (const std::uint32_t next : ways_[op].to)
          if (parent[next] != kUnknown) common = common == kUnknown ? next : meet(common, next);
        changed |= std::exchange(parent[op], common) != common;
      }
    }
    number_tree(order, parent);
  }

  /// The end and all ops with a way to it, each after one that it leads to.
  std::vector<std::uint32_t> from_the_end() const {
    std::vector<std::vector<std::uint32_t>> comes_from(count_ + 1);
    for (std::uint32_t i = 0; i < count_; ++i) {
      for (const std::uint32_t next : ways_[i].to) comes_from[next].push_back(i);
      if (ways_[i].end) comes_from[count_].push_back(i);
    }
    std::vector<bool> seen(count_ + 1);
    std::vector<std::uint32_t> order;
    std::vector<std::pair<std::uint32_t, std::size_t>> open{{count_, 0}};  // op, how many of those before it are done
    seen[count_] = true;
    while (!open.empty()) {
      auto& [op, done] = open.back();
      if (done == comes_from[op].size()) {
        order.push_back(op);
        open.pop_back();
      } else if (const std::uint32_t before = comes_from[op][done++]; !seen[before]) {
        seen[before] = true;
        open.emplace_back(before, 0);
      }
    }
    std::ranges::reverse(order);
    return order;
  }

  /// Numbers the ops so that those below an op in the tree have the numbers of its span.
  void number_tree(const std::vector<std::uint32_t>& order, const std::vector<std::uint32_t>& parent) {
    ends_.assign(count_ + 1, false);
    span_.assign(count_ + 1, {0, 0});
    std::vector<std::uint32_t> below(count_ + 1, 1), next(count_ + 1, 0);
    for (std::size_t i = order.size(); --i > 0;) below[parent[order[i]]] += below[order[i]];
    for (const std::uint32_t op : order) {
      const std::uint32_t first = op == count_ ? 0 : next[parent[op]];
      ends_[op] = true;
      span_[op] = {first, first + below[op] - 1};
      if (op != count_) next[parent[op]] = first + below[op];
      next[op] = first + 1;
    }
  }

  bool routine_in_every_scan(std::uint32_t head) {
    if (head == 0) return true;
    const auto [known, added] = called_.try_emplace(head, false);  // until it is known; a recursive call finds this value
    if (!added) return known->second;
    for (std::uint32_t i = 0; i < count_ && !called_[head]; ++i)
      if (structure(i) == Structure::Call && program_.ops[i].target == head && on_[i]) called_[head] = in_every_scan(i);
    return called_[head];
  }

  const Program& program_;
  std::uint32_t count_;
  std::vector<std::uint32_t> head_;
  std::vector<bool> on_;  // whether the top of the stack is known to be 1 before each op
  std::vector<Ways> ways_;
  std::vector<std::uint32_t> straight_, straight_end_;         // of an op: its straight; of a straight: its end
  std::vector<bool> ends_;                                     // whether some way leads from an op to the end of its routine
  std::vector<std::pair<std::uint32_t, std::uint32_t>> span_;  // of an op's numbers in the tree of post-dominators
  std::map<std::uint32_t, bool> called_;                       // by routine: whether every scan calls it
};

/// The instructions seen so far that work on the same coil, timer or counter.
struct Earlier {
  std::map<std::uint32_t, std::uint32_t> last;  ///< by routine
  std::optional<std::uint32_t> in_every_scan;   ///< the first one that every scan executes

  void add(Flow& flow, std::uint32_t op) {
    last[flow.head(op)] = op;
    if (!in_every_scan && flow.in_every_scan(op)) in_every_scan = op;
  }
  /// The one in the same routine that is always followed by `op`.
  std::optional<std::uint32_t> before(const Flow& flow, std::uint32_t op) const {
    const auto found = last.find(flow.head(op));
    if (found == last.end() || !flow.leads_to(found->second, op)) return {};
    return found->second;
  }
  /// The one that every scan executes as well as `op`.
  std::optional<std::uint32_t> beside(Flow& flow, std::uint32_t op) const {
    return in_every_scan && flow.in_every_scan(op) ? in_every_scan : std::nullopt;
  }
};

// --- coils ---

constexpr Bits kOutputBits{image::kQ * 8u, image::kPointBytes * 8u};

/// Which ops use what the coils of a program write.
class Uses {
 public:
  explicit Uses(const Program& program) : program_(program) {
    for (const std::uint32_t coil : ops_with(program, Effect::Coil))
      by_byte_[bits_of(program, program.ops[coil], 0).first / 8];
    for (std::uint32_t i = 0; i < program.ops.size(); ++i) note(i);
  }

  /// Whether one of the stretches uses this bit, or calls what may use it.
  bool any(const Bits& bit, const std::vector<Stretch>& stretches) const {
    const std::vector<Use>& of_byte = by_byte_.at(bit.first / 8);
    const bool by_pointer = pointers_reach(program_, bit);
    return std::ranges::any_of(stretches, [&](const Stretch& stretch) {
      const auto [first, last] = within(of_byte, stretch);
      return std::any_of(first, last, [&](const Use& use) { return use.bits.overlap(bit); }) || is_any(calls_, stretch) ||
             (by_pointer && is_any(pointers_, stretch));
    });
  }

 private:
  struct Use {
    std::uint32_t op = 0;
    Bits bits;
  };

  void note(std::uint32_t i) {
    const Op& op = program_.ops[i];
    if (op.instruction->structure == Structure::Call || is_unread(op)) calls_.push_back({i, {}});
    if (op.instruction->effect == Effect::Coil) return;
    for (std::size_t k = 0; k < op.instruction->rules().size(); ++k) {
      if (op.instruction->operand[k].kind != OperandKind::Memory) continue;
      if (op[k].unread()) {
        calls_.push_back({i, {}});
        continue;
      }
      if (op[k].pointer) {
        pointers_.push_back({i, {}});
        continue;
      }
      const Bits bits = bits_of(program_, op, k);
      const auto end = by_byte_.lower_bound((bits.first + bits.count + 7) / 8);
      for (auto byte = by_byte_.lower_bound(bits.first / 8); byte != end; ++byte) byte->second.push_back({i, bits});
    }
  }

  static std::pair<std::vector<Use>::const_iterator, std::vector<Use>::const_iterator> within(const std::vector<Use>& uses,
                                                                                              const Stretch& stretch) {
    const auto first = std::ranges::lower_bound(uses, stretch.from, {}, &Use::op);
    return {first, std::ranges::lower_bound(first, uses.end(), stretch.to, {}, &Use::op)};
  }
  static bool is_any(const std::vector<Use>& uses, const Stretch& stretch) {
    const auto [first, last] = within(uses, stretch);
    return first != last;
  }

  const Program& program_;
  std::map<std::uint64_t, std::vector<Use>> by_byte_;  // of the bytes that coils write; by op
  std::vector<Use> pointers_, calls_;                  // by op
};

// --- timers and counters ---

/// Two instructions of the same timer or counter where every scan that executes one also executes the other.
void find_executed_twice(const Program& program, Area area, Warning warning, std::string_view trouble,
                         stl::Diagnostics& diagnostics) {
  const auto counts = [&](const Op& op) {
    return op.instruction->hidden == Hidden::Number && op.instruction->operand[0].areas == set_of(area);
  };
  if (std::ranges::count_if(program.ops, counts) < 2) return;
  Flow flow(program);
  std::map<std::uint32_t, Earlier> executed;
  for (std::uint32_t i = 0; i < program.ops.size(); ++i) {
    const Op& op = program.ops[i];
    if (!counts(op) || op[0].unread()) continue;
    Earlier& earlier = executed[op[2].at];
    auto other = earlier.before(flow, i);
    if (!other) other = earlier.beside(flow, i);
    if (other)
      diagnostics.push_back(
          warn(warning, place(program, i),
               fmt::format("{} is already used in line {}: {}", written(program, i, 0), line(program, *other), trouble),
               "give each one its own number", fmt::format("number {}", written(program, i, 0))));
    earlier.add(flow, i);
  }
}

// --- steps ---

constexpr Bits kStepBits{image::kS * 8u, 32 * 8u};

std::string step_text(std::uint64_t bit) {
  const auto number = static_cast<std::uint32_t>(bit - kStepBits.first);
  return address_text(Area::S, Width::Bit, number / 8, static_cast<std::uint8_t>(number % 8));
}

/// The S bits that LSCR, contacts and other instructions read.
std::set<std::uint64_t> loaded_steps(const Program& program) {
  std::set<std::uint64_t> loaded;
  for (const Op& op : program.ops)
    for (std::size_t i = 0; i < op.instruction->rules().size(); ++i) {
      const OperandRule& rule = op.instruction->operand[i];
      if (rule.kind != OperandKind::Memory || rule.role == Role::Out || op[i].pointer) continue;
      const Bits bits = op[i].unread() ? kStepBits : bits_of(program, op, i);
      if (!bits.overlap(kStepBits)) continue;
      for (std::uint64_t bit = bits.first; bit < bits.first + bits.count; ++bit) loaded.insert(bit);
    }
  return loaded;
}

}  // namespace

void find_double_coils(const Program& program, stl::Diagnostics& diagnostics) {
  Flow flow(program);
  const Uses uses(program);
  const std::vector<Stretch> interrupts = flow.interrupts();
  std::map<std::uint64_t, Earlier> coils;
  for (const std::uint32_t coil : ops_with(program, Effect::Coil)) {
    if (program.ops[coil][0].unread()) continue;
    const Bits bit = bits_of(program, program.ops[coil], 0);
    const bool output = bit.overlap(kOutputBits);
    Earlier& earlier = coils[bit.first];
    auto other = earlier.before(flow, coil);
    const bool used = other && !output && (uses.any(bit, flow.between(*other, coil)) || uses.any(bit, interrupts));
    if (used) other.reset();
    if (!other && output) other = earlier.beside(flow, coil);
    if (other)
      diagnostics.push_back(warn(Warning::DoubleCoil, place(program, coil),
                                 fmt::format("{} is already a coil in line {}; the coil that is executed last decides",
                                             written(program, coil, 0), line(program, *other)),
                                 "join both conditions in one rung, or use S and R",
                                 fmt::format("coil {}", written(program, coil, 0))));
    earlier.add(flow, coil);
  }
}

void find_double_timers(const Program& program, stl::Diagnostics& diagnostics) {
  find_executed_twice(program, Area::T, Warning::DoubleTimer, "a timer executed twice in a scan does not keep time",
                      diagnostics);
}

void find_double_counters(const Program& program, stl::Diagnostics& diagnostics) {
  find_executed_twice(program, Area::C, Warning::DoubleCounter, "both instructions count and reset the same value",
                      diagnostics);
}

void find_double_loops(const Program& program, stl::Diagnostics& diagnostics) {
  std::map<std::uint32_t, std::uint32_t> first;  // by loop
  for (std::uint32_t i = 0; i < program.ops.size(); ++i) {
    if (program.ops[i].instruction->hidden != Hidden::LoopMemory || program.ops[i][1].unread()) continue;
    const std::uint32_t loop = program.ops[i][1].at;
    const auto [found, added] = first.emplace(loop, i);
    if (!added)
      diagnostics.push_back(warn(Warning::DoubleLoop, place(program, i),
                                 fmt::format("loop {} already has a PID in line {}; they would disturb each other", loop,
                                             line(program, found->second)),
                                 "give each PID a loop of its own", fmt::format("loop {}", loop)));
  }
}

void find_missing_eni(const Program& program, stl::Diagnostics& diagnostics) {
  if (!ops_with(program, Effect::EnablesInterrupts).empty() || has_unread(program)) return;
  for (const std::uint32_t attach : attachments(program)) {
    if (program.ops[attach][0].unread()) continue;
    diagnostics.push_back(warn(Warning::NoEni, place(program, attach),
                               fmt::format("INT {} is never executed: the program has no ENI", program.ops[attach][0].at),
                               "execute ENI once, after ATCH", "no ENI"));
  }
}

void find_unused_steps(const Program& program, stl::Diagnostics& diagnostics) {
  if (contains(program.pointed_at, Area::S) || has_unread(program)) return;  // it may read all of it
  std::optional<std::set<std::uint64_t>> loaded;
  for (std::uint32_t i = 0; i < program.ops.size(); ++i) {
    const Op& op = program.ops[i];
    const Effect effect = op.instruction->effect;
    const bool sets =
        effect == Effect::SetsBits || effect == Effect::Coil || op.instruction->structure == Structure::SegmentTransition;
    if (!sets || !kStepBits.overlap(bits_of(program, op, 0))) continue;
    if (!loaded) loaded = loaded_steps(program);
    const Bits bits = bits_of(program, op, 0);
    for (std::uint64_t bit = bits.first; bit < bits.first + bits.count; ++bit) {
      if (loaded->contains(bit)) continue;
      diagnostics.push_back(warn(Warning::UnusedStep, place(program, i),
                                 fmt::format("{} is set, but neither a segment nor a contact loads it", step_text(bit)),
                                 fmt::format("the segment of this step begins with LSCR {}", step_text(bit))));
      break;
    }
  }
}

}  // namespace s7200
