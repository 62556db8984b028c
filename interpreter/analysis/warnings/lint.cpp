#include "interpreter/analysis/warnings/lint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "interpreter/analysis/flow/calls.hpp"
#include "interpreter/analysis/flow/paths.hpp"
#include "interpreter/analysis/warnings/lint_ops.hpp"
#include "interpreter/program/checking/warnings.hpp"
#include "interpreter/program/operands/operands.hpp"

namespace s7200 {
namespace {

using namespace lint;

/// The instructions seen so far that work on the same coil, timer or counter.
struct Earlier {
  std::map<std::uint32_t, std::uint32_t> last;  ///< by routine
  std::optional<std::uint32_t> in_every_scan;   ///< the first one that every scan executes

  void add(Paths& paths, std::uint32_t op) {
    last[paths.routine(op)] = op;
    if (!in_every_scan && paths.in_every_scan(op)) in_every_scan = op;
  }
  /// The one in the same routine that is always followed by `op`.
  std::optional<std::uint32_t> before(const Paths& paths, std::uint32_t op) const {
    const auto found = last.find(paths.routine(op));
    if (found == last.end() || !paths.leads_to(found->second, op)) return {};
    return found->second;
  }
  /// The one that every scan executes as well as `op`.
  std::optional<std::uint32_t> beside(Paths& paths, std::uint32_t op) const {
    return in_every_scan && paths.in_every_scan(op) ? in_every_scan : std::nullopt;
  }
};

// --- coils ---

constexpr Bits kOutputBits{image::kQ * 8u, image::kPointBytes * 8u};

std::string winner_text(const Facts& facts, std::uint32_t coil, std::uint32_t other) {
  if (last_way_to(facts.flow, coil) < last_way_to(facts.flow, other)) std::swap(coil, other);
  return fmt::format("the coil in line {} is executed last and decides, not the one in line {}", line(facts.program, coil),
                     line(facts.program, other));
}

/// Whether an op is in an interrupt routine that an event starts, and the other one in the main program or in what it calls.
bool interrupts_other(const ControlFlow& flow, const Calls& calls, std::uint32_t op, std::uint32_t other) {
  const Calls::Node& node = calls.nodes[flow.nodes[op].routine];
  return !node.by_main && node.by_interrupt && calls.nodes[flow.nodes[other].routine].by_main;
}

/// Which ops use what the coils of a program write.
class Uses {
 public:
  explicit Uses(const Facts& facts) : program_(facts.program) {
    for (const std::uint32_t coil : ops_with(program_, Effect::Coil))
      by_byte_[bits_of(program_, program_.ops[coil], 0).first / 8];
    for (std::uint32_t i = 0; i < program_.ops.size(); ++i) {
      if (program_.ops[i].instruction->structure == Structure::Call) calls_.push_back({i, {}});
      if (program_.ops[i].instruction->effect == Effect::Coil) continue;
      for (const MemoryAccess& access : facts.effects[i]) note(i, access);
    }
  }

  /// Whether one of the stretches uses this bit, or calls what may use it.
  bool any(const Bits& bit, const std::vector<Stretch>& stretches) const {
    const std::vector<Use>& of_byte = by_byte_.at(bit.first / 8);
    return std::ranges::any_of(stretches, [&](const Stretch& stretch) {
      const auto [first, last] = within(of_byte, stretch);
      return std::any_of(first, last, [&](const Use& use) { return is_meant(program_, use.access, bit); }) ||
             is_any(calls_, stretch);
    });
  }

 private:
  struct Use {
    std::uint32_t op = 0;
    MemoryAccess access;
  };

  void note(std::uint32_t i, const MemoryAccess& access) {
    const auto end = by_byte_.lower_bound((access.bits.end() + 7) / 8);
    for (auto byte = by_byte_.lower_bound(access.bits.first / 8); byte != end; ++byte) byte->second.push_back({i, access});
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
  std::vector<Use> calls_;                             // by op
};

// --- timers and counters ---

/// Two instructions of the same timer or counter where every scan that executes one also executes the other.
void find_executed_twice(const Facts& facts, Area area, Warning warning, std::string_view trouble,
                         stl::Diagnostics& diagnostics) {
  const Program& program = facts.program;
  const auto counts = [&](const Op& op) {
    return op.instruction->hidden == Hidden::Number && op.instruction->operand[0].areas == set_of(area);
  };
  if (std::ranges::count_if(program.ops, counts) < 2) return;
  Paths paths(program, facts.flow);
  std::map<std::uint32_t, Earlier> executed;
  for (std::uint32_t i = 0; i < program.ops.size(); ++i) {
    const Op& op = program.ops[i];
    if (!counts(op) || op[0].unread()) continue;
    Earlier& earlier = executed[op[2].at];
    auto other = earlier.before(paths, i);
    if (!other) other = earlier.beside(paths, i);
    if (other)
      diagnostics.push_back(
          warn(warning, place(program, i),
               fmt::format("{} is already used in line {}: {}", written(program, i, 0), line(program, *other), trouble),
               "give each one its own number", fmt::format("number {}", written(program, i, 0))));
    earlier.add(paths, i);
  }
}

// --- steps ---

constexpr Bits kStepBits{image::kS * 8u, 32 * 8u};

std::string step_text(std::uint64_t bit) {
  const auto number = static_cast<std::uint32_t>(bit - kStepBits.first);
  return address_text(Area::S, Width::Bit, number / 8, static_cast<std::uint8_t>(number % 8));
}

/// The S bits that LSCR, contacts and other instructions read.
std::set<std::uint64_t> loaded_steps(const Facts& facts) {
  std::set<std::uint64_t> loaded;
  for (const std::vector<MemoryAccess>& effects : facts.effects)
    for (const MemoryAccess& access : effects) {
      if (!access.reads() || access.by_pointer || !access.bits.overlaps(kStepBits)) continue;
      const std::uint64_t end = std::min(access.bits.end(), kStepBits.end());
      for (std::uint64_t bit = std::max(access.bits.first, kStepBits.first); bit < end; ++bit) loaded.insert(bit);
    }
  return loaded;
}

}  // namespace

void find_double_coils(const Facts& facts, stl::Diagnostics& diagnostics) {
  const Program& program = facts.program;
  Paths paths(program, facts.flow);
  const Calls calls = calls_of(program, facts.flow);
  const Uses uses(facts);
  const std::vector<Stretch> interrupts = paths.interrupts();
  std::map<std::uint64_t, Earlier> coils;
  for (const std::uint32_t coil : ops_with(program, Effect::Coil)) {
    if (program.ops[coil][0].unread()) continue;
    const Bits bit = bits_of(program, program.ops[coil], 0);
    const bool output = bit.overlaps(kOutputBits);
    Earlier& earlier = coils[bit.first];
    auto other = earlier.before(paths, coil);
    const bool used = other && !output && (uses.any(bit, paths.between(*other, coil)) || uses.any(bit, interrupts));
    if (used) other.reset();
    if (!other && output) other = earlier.beside(paths, coil);
    const auto scan =
        !other && output && earlier.in_every_scan && interrupts_other(facts.flow, calls, coil, *earlier.in_every_scan)
            ? earlier.in_every_scan
            : std::nullopt;
    const auto add = [&](std::uint32_t first, std::string_view rest, std::string hint) {
      const std::string name = written(program, coil, 0);
      diagnostics.push_back(warn(Warning::DoubleCoil, place(program, coil),
                                 fmt::format("{} is already a coil in line {}{}", name, line(program, first), rest),
                                 std::move(hint), fmt::format("coil {}", name)));
    };
    if (scan)
      add(*scan, ", which every scan executes: it decides, not this one of an interrupt",
          "join both conditions in one rung, or set a bit here that the rung in the scan looks at");
    if (other) add(*other, "; " + winner_text(facts, coil, *other), "join both conditions in one rung, or use S and R");
    earlier.add(paths, coil);
  }
}

void find_double_timers(const Facts& facts, stl::Diagnostics& diagnostics) {
  find_executed_twice(facts, Area::T, Warning::DoubleTimer, "a timer executed twice in a scan does not keep time",
                      diagnostics);
}

void find_double_counters(const Facts& facts, stl::Diagnostics& diagnostics) {
  find_executed_twice(facts, Area::C, Warning::DoubleCounter, "both instructions count and reset the same value",
                      diagnostics);
}

void find_double_loops(const Facts& facts, stl::Diagnostics& diagnostics) {
  const Program& program = facts.program;
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

void find_missing_eni(const Facts& facts, stl::Diagnostics& diagnostics) {
  const Program& program = facts.program;
  if (!ops_with(program, Effect::EnablesInterrupts).empty() || has_unread(program)) return;
  for (const std::uint32_t attach : attachments(program)) {
    if (program.ops[attach][0].unread()) continue;
    diagnostics.push_back(warn(Warning::NoEni, place(program, attach),
                               fmt::format("INT {} is never executed: the program has no ENI", program.ops[attach][0].at),
                               "execute ENI once, after ATCH", "no ENI"));
  }
}

void find_unused_steps(const Facts& facts, stl::Diagnostics& diagnostics) {
  const Program& program = facts.program;
  if (contains(program.pointed_at, Area::S) || has_unread(program)) return;  // it may read all of it
  std::optional<std::set<std::uint64_t>> loaded;
  for (std::uint32_t i = 0; i < program.ops.size(); ++i) {
    const Op& op = program.ops[i];
    const Effect effect = op.instruction->effect;
    const bool sets =
        effect == Effect::SetsBits || effect == Effect::Coil || op.instruction->structure == Structure::SegmentTransition;
    if (!sets || !kStepBits.overlaps(bits_of(program, op, 0))) continue;
    if (!loaded) loaded = loaded_steps(facts);
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
