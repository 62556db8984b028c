#include "interpreter/analysis/reaching_values.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <iterator>
#include <set>
#include <span>
#include <string_view>
#include <tuple>

#include "interpreter/analysis/cross_reference.hpp"
#include "interpreter/analysis/effects.hpp"
#include "interpreter/analysis/pointers.hpp"
#include "interpreter/base/bytes.hpp"
#include "interpreter/model/contact_form.hpp"

namespace s7200 {
namespace {

constexpr std::int64_t kAreaSize = 0x100'0000;  ///< addresses that a pointer's top byte leaves
constexpr int kNarrowings = 2;
constexpr int kPatience = 4;  ///< times that a value may grow where ways meet before it is widened

Structure structure_at(const Op& op) { return op.instruction->structure; }

bool is_place_within(std::uint32_t at, std::uint32_t bytes, std::uint32_t from, std::uint32_t to) {
  return at >= from && at + bytes <= to;
}
bool is_accumulator(std::uint32_t at) { return is_place_within(at, 1, image::kAC, image::kTBits); }
bool is_local_place(std::uint32_t at) { return is_place_within(at, 1, image::kL, image::kConstants); }

/// Memory that neither the CPU nor the field changes by itself.
bool is_quiet(std::uint32_t at, std::uint32_t bytes) {
  return is_place_within(at, bytes, image::kM, image::kSM) || is_accumulator(at) ||
         is_place_within(at, bytes, image::kV, image::kConstants);
}

// --- what boxes compute ---

using Computes = ValueSet (*)(const ValueSet& in, const ValueSet& old);

ValueSet carried(const ValueSet& in, const ValueSet&) { return in; }
ValueSet added_up(const ValueSet& in, const ValueSet& old) { return old.plus(in); }
ValueSet taken_off(const ValueSet& in, const ValueSet& old) { return old.plus(in.negated()); }
ValueSet multiplied(const ValueSet& in, const ValueSet& old) { return old.times(in); }
ValueSet one_more(const ValueSet&, const ValueSet& old) { return old.plus({1, 1}); }
ValueSet one_less(const ValueSet&, const ValueSet& old) { return old.plus({-1, -1}); }

const ValueSet kAnyDouble = ValueSet::all_of(Width::Double);

ValueSet divided(const ValueSet& in, const ValueSet& old) {
  const auto divisor = in.single();
  return divisor && *divisor > 0 ? old.divided_by(*divisor) : kAnyDouble;
}
ValueSet masked_value(const ValueSet& in, const ValueSet& old) {
  std::optional<std::int64_t> most;
  for (const ValueSet* each : {&in, &old}) {
    if (each->empty()) return {};
    if (each->least() >= 0) most = std::min(most.value_or(each->most()), each->most());
  }
  return most ? ValueSet(0, *most) : kAnyDouble;
}
ValueSet shifted_left(const ValueSet& places, const ValueSet& old) {
  const auto by = places.single();
  return by && *by <= 31 ? old.times({std::int64_t{1} << *by, std::int64_t{1} << *by}) : kAnyDouble;
}
ValueSet shifted_right(const ValueSet& places, const ValueSet& old) {
  const auto by = places.single();
  return by && *by <= 31 && !old.empty() && old.least() >= 0 ? old.divided_by(std::int64_t{1} << *by) : kAnyDouble;
}

struct Computation {
  std::string_view mnemonic;
  Computes result;
};
constexpr std::array kComputations{
    Computation{"MOVB", carried},      Computation{"MOVW", carried},      Computation{"MOVD", carried},
    Computation{"BTI", carried},       Computation{"ITB", carried},       Computation{"ITD", carried},
    Computation{"DTI", carried},       Computation{"INCB", one_more},     Computation{"INCW", one_more},
    Computation{"INCD", one_more},     Computation{"DECB", one_less},     Computation{"DECW", one_less},
    Computation{"DECD", one_less},     Computation{"+I", added_up},       Computation{"+D", added_up},
    Computation{"-I", taken_off},      Computation{"-D", taken_off},      Computation{"*I", multiplied},
    Computation{"*D", multiplied},     Computation{"/I", divided},        Computation{"/D", divided},
    Computation{"ANDB", masked_value}, Computation{"ANDW", masked_value}, Computation{"ANDD", masked_value},
    Computation{"SLB", shifted_left},  Computation{"SLW", shifted_left},  Computation{"SLD", shifted_left},
    Computation{"SRB", shifted_right}, Computation{"SRW", shifted_right}, Computation{"SRD", shifted_right}};

/// A box whose result is known from its operands: where it puts it, and the operand that it only reads.
struct ValueBox {
  Computes result = nullptr;
  std::uint8_t to = 0;
  std::optional<std::uint8_t> from;
};

std::optional<ValueBox> value_box_of(const Instruction& instruction) {
  const auto found = std::ranges::find(kComputations, instruction.mnemonic, &Computation::mnemonic);
  if (found == kComputations.end()) return {};
  ValueBox box{.result = found->result, .to = 0, .from = {}};
  for (std::uint8_t i = 0; i < instruction.rules().size(); ++i) {
    if (instruction.operand[i].role == Role::In)
      box.from = i;
    else
      box.to = i;
  }
  return box;
}

std::optional<std::int64_t> constant_value(const Program& program, const Operand& operand, Width width) {
  if (operand.pointer || operand.unread() || operand.at < image::kConstants) return {};
  const std::uint8_t* at = &program.constants[operand.at - image::kConstants];
  switch (width) {
    case Width::Double:
      return static_cast<std::int32_t>(load32(at));
    case Width::Word:
      return static_cast<std::int16_t>(load16(at));
    default:
      return *at;
  }
}

/// Whether an access is one of the op's operands, and not flags, nor what CALL and RET do besides.
bool is_of_operand(const MemoryAccess& access) {
  return access.operand != kNoOperand || access.by_pointer || access.bits.contains({0, image::kConstants * 8u});
}

/// Whether the system goes on writing memory after the op.
bool lets_the_system_write(const Op& op) {
  const std::string_view mnemonic = op.instruction->mnemonic;
  return op.instruction->effect == Effect::Receives || mnemonic == "NETR" || mnemonic == "NETW";
}

bool is_for(const Op& op) { return structure_at(op) == Structure::For; }

/// CALL clears the local memory of the subroutine, which is another one.
bool is_local_clearing(const MemoryAccess& access) { return access.bits == Bits{image::kL * 8u, 64 * 8}; }

/// The ops between a FOR and its NEXT, and those that they call.
std::vector<std::uint32_t> ops_of_passes(const ControlFlow& flow, const Program& program, std::uint32_t loop) {
  std::vector<std::uint32_t> all;
  std::set<std::uint32_t> called;
  for (std::uint32_t op = loop + 1; op + 1 < program.ops[loop].target; ++op) all.push_back(op);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (structure_at(program.ops[all[i]]) != Structure::Call) continue;
    const Routine& routine = flow.routine_of(program.ops[all[i]].target);
    if (!called.insert(routine.first).second) continue;
    for (std::uint32_t op = routine.first; op < routine.end; ++op) all.push_back(op);
  }
  return all;
}

}  // namespace

std::vector<PointerTarget> places_of(const Program& program, const ValueSet& addresses) {
  std::vector<PointerTarget> all;
  for (const ValueRange& range : addresses.ranges())
    for (std::int64_t code = std::max<std::int64_t>(0, range.least / kAreaSize); code <= range.most / kAreaSize; ++code) {
      if (code >= std::int64_t{kReaches}) break;
      const Reach& reach = program.reach[static_cast<std::size_t>(code)];
      const std::int64_t first = std::max<std::int64_t>(0, range.least - code * kAreaSize);
      const std::int64_t end = std::min<std::int64_t>(reach.size, range.most - code * kAreaSize + 1);
      if (first < end)
        all.push_back({reach.base + static_cast<std::uint32_t>(first), reach.base + static_cast<std::uint32_t>(end)});
    }
  return all;
}

std::optional<std::int64_t> step_of(const Program& program, const Op& op) {
  const std::string_view mnemonic = op.instruction->mnemonic;
  const auto box = value_box_of(*op.instruction);
  if (!box) return {};
  if (box->result == one_more) return 1;
  if (box->result == one_less) return -1;
  if (box->result != added_up && box->result != taken_off) return {};
  const auto added = constant_value(program, op[*box->from], op.instruction->operand[*box->from].width);
  if (!added || std::abs(*added) >= kAreaSize) return {};
  return mnemonic.front() == '-' ? -*added : *added;
}

bool counts_its_passes(const ControlFlow& flow, const Program& program,
                       const std::vector<std::vector<MemoryAccess>>& effects, std::uint32_t op) {
  const Op& loop = program.ops[op];
  if (loop[0].pointer || loop[0].unread() || loop[1].pointer || loop[2].pointer || !is_quiet(loop[0].at, 2)) return false;
  const Bits index{loop[0].at * 8u, 16}, last{loop[2].at * 8u, 16};
  const auto meddles = [&](std::uint32_t in) {
    return std::ranges::any_of(effects[in], [&](const MemoryAccess& access) {
      const bool there = access.bits.overlaps(index) || access.bits.overlaps(last);
      return access.writes() && there && !is_local_clearing(access) && !is_anywhere(program, access);
    });
  };
  for (const std::uint32_t in : ops_of_passes(flow, program, op))
    if (meddles(in)) return false;
  const Routine& routine = flow.routine_of(op);
  for (std::uint32_t other = routine.first; other < routine.end; ++other) {
    if (other >= op && other < loop.target) continue;
    for (const std::uint32_t next : flow.nodes[other].next)
      if (next > op && next < loop.target) return false;
  }
  return true;
}

/// Follows the values through a program until they grow no more.
class ValueFollower {
 public:
  ValueFollower(const Program& program, const ControlFlow& flow, const std::vector<std::vector<MemoryAccess>>& effects,
                const Pointers& pointers, ReachingValues& result)
      : program_(program),
        flow_(flow),
        effects_(effects),
        pointers_(pointers),
        calls_(calls_of(program, flow)),
        result_(result) {}

  void follow() {
    find_cells();
    if (cells_.empty()) return;
    find_writers();
    find_loops();
    find_leaders();
    begin();
    while (!waiting_.empty()) {
      const std::uint32_t leader = *waiting_.begin();
      waiting_.erase(waiting_.begin());
      walk(leader);
    }
    for (int round = 0; round < kNarrowings; ++round) narrow();
    phase_ = Phase::Recording;
    walk_all();
  }

 private:
  /// Values first grow until nothing changes. Where loops made them grow too far, they are worked out again from what comes
  /// from below, which is known by then.
  enum class Phase : std::uint8_t { Growing, FromBelow, FromAbove, Recording };

  /// A byte, word or double word whose values are followed.
  struct Cell {
    std::uint32_t at = 0;
    Width width = Width::Double;
    bool kept = false;          ///< from one scan to the next
    bool set_by_name = false;   ///< some instruction writes it, and not through a pointer
    bool by_interrupt = false;  ///< an interrupt routine writes it
    bool by_system = false;     ///< the system does, at any time
    std::set<std::int64_t> compared{};

    Bits bits() const { return {at * 8u, bytes_of(width) * 8u}; }
  };

  /// The values of all cells; empty where no way leads.
  using Memory = std::vector<ValueSet>;

  /// What reaches an op with power flow, and what without.
  struct State {
    std::optional<Memory> on{}, off{};
    bool reached() const { return on || off; }
  };

  struct Loop {
    bool counts = false;                             ///< counts_its_passes()
    std::vector<std::optional<ValueRange>> drift{};  ///< by cell: what a pass adds; nothing if that is not known
    bool reached = false;
    std::optional<std::int64_t> passes{};  ///< at most, as far as followed
    ValueSet index{};                      ///< during the passes
  };

  // --- cells ---

  void find_cells() {
    for (const Op& op : program_.ops) {
      for (const Operand& operand : op.operand)
        if (operand.pointer) want(operand.at, Width::Double);
      if (!is_for(op)) continue;
      want(op[1], Width::Word);
      want(op[2], Width::Word);
    }
    for (const Parameter& parameter : program_.parameters)
      if (parameter.actual.pointer) want(parameter.actual.at, Width::Double);
    for (std::size_t before = 0; before != cells_.size();) {
      before = cells_.size();
      want_sources();
    }
    for (const Op& op : program_.ops) {
      note_comparison(op);
      note_counting(op);
    }
  }

  /// What the program counts is its own.
  void note_counting(const Op& op) {
    if (!step_of(program_, op)) return;
    const ValueBox box = *value_box_of(*op.instruction);
    if (const auto cell = cell_of(op[box.to], op.instruction->operand[box.to].width)) cells_[*cell].kept = true;
  }

  void want(const Operand& operand, Width width) {
    if (!operand.pointer && !operand.unread() && operand.at < image::kConstants) want(operand.at, width);
  }
  void want(std::uint32_t at, Width width) {
    if (is_accumulator(at)) std::tie(at, width) = std::pair(image::kAC + (at - image::kAC) / 4 * 4, Width::Double);
    if (!is_quiet(at, bytes_of(width)) || !number_.try_emplace({at, width}, cells_.size()).second) return;
    Cell cell{.at = at, .width = width};
    cell.kept = is_accumulator(at) || (width == Width::Double && pointers_.at_any_time(at));
    cells_.push_back(cell);
  }

  void want_sources() {
    for (const Op& op : program_.ops) {
      const auto box = value_box_of(*op.instruction);
      if (!box || !box->from || op[box->to].pointer || !is_followed(op[box->to].at, op.instruction->operand[box->to].width))
        continue;
      want(op[*box->from], op.instruction->operand[*box->from].width);
    }
    for (const Parameter& parameter : program_.parameters) {
      if (parameter.width == Width::Bit) continue;
      if (is_followed(parameter.local.at, parameter.width)) want(parameter.actual, parameter.width);
      if (!parameter.actual.pointer && is_followed(parameter.actual.at, parameter.width))
        want(parameter.local, parameter.width);
    }
  }

  bool is_followed(std::uint32_t at, Width width) const {
    const Bits bits{at * 8u, bytes_of(width) * 8u};
    return std::ranges::any_of(cells_, [&](const Cell& cell) { return cell.bits().overlaps(bits); });
  }

  std::optional<std::size_t> cell_of(const Operand& operand, Width width) const {
    if (operand.pointer || operand.unread()) return {};
    const auto found = number_.find({operand.at, width});
    return found == number_.end() ? std::nullopt : std::optional(found->second);
  }

  /// Loops that a comparison ends go on to the constant beside it.
  void note_comparison(const Op& op) {
    const ContactForm form = contact_form(*op.instruction);
    if (form.kind != ContactForm::Kind::Numbers || form.type == ContactForm::Type::Real) return;
    const Width width = op.instruction->operand[0].width;
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
      const auto cell = cell_of(op[i], width);
      const auto with = constant_value(program_, op[1 - i], width);
      if (cell && with) cells_[*cell].compared.insert({*with - 1, *with, *with + 1});
    }
  }

  // --- who writes them ---

  void find_writers() {
    direct_.assign(flow_.routines.size(), std::vector<bool>(cells_.size()));
    for (std::uint32_t op = 0; op < program_.ops.size(); ++op)
      for (const MemoryAccess& access : effects_[op]) {
        const bool by_call = structure_at(program_.ops[op]) == Structure::Call && !is_local_clearing(access);
        if (!access.writes() || !(is_of_operand(access) || by_call)) continue;
        for (std::size_t i = 0; i < cells_.size(); ++i) {
          if (!access.bits.overlaps(cells_[i].bits())) continue;
          direct_[flow_.nodes[op].routine][i] = true;
          if (!access.by_pointer) cells_[i].set_by_name = true;
          if (lets_the_system_write(program_.ops[op])) cells_[i].by_system = true;
        }
      }
    writes_ = direct_;
    for (bool more = true; more;) {
      more = false;
      for (const CallSite& site : flow_.calls)
        for (std::size_t i = 0; i < cells_.size(); ++i)
          if (writes_[site.routine][i] && !writes_[flow_.nodes[site.op].routine][i] && !is_local_place(cells_[i].at))
            more = writes_[flow_.nodes[site.op].routine][i] = true;
    }
    for (std::size_t routine = 0; routine < flow_.routines.size(); ++routine)
      for (std::size_t i = 0; i < cells_.size(); ++i)
        if (calls_.nodes[routine].by_interrupt && direct_[routine][i] && !is_own(cells_[i])) cells_[i].by_interrupt = true;
  }

  /// Saved for interrupts, or memory of its own in each routine.
  static bool is_own(const Cell& cell) { return is_accumulator(cell.at) || is_local_place(cell.at); }

  // --- loops ---

  void find_loops() {
    for (std::uint32_t op = 0; op < program_.ops.size(); ++op) {
      if (!is_for(program_.ops[op])) continue;
      Loop& loop = loops_[op];
      loop.counts = counts_its_passes(flow_, program_, effects_, op) && !changes_elsewhere(program_.ops[op][0]);
    }
  }
  bool changes_elsewhere(const Operand& index) const {
    const auto cell = cell_of(index, Width::Word);
    return cell && (cells_[*cell].by_interrupt || cells_[*cell].by_system);
  }

  /// What a pass of a loop adds to each cell, if its body only counts it. Inner loops count as often as they run.
  std::vector<std::optional<ValueRange>> drift_of(std::uint32_t op) const {
    std::vector<std::optional<ValueRange>> drift(cells_.size(), ValueRange{});
    const std::uint32_t end = program_.ops[op].target - 1;
    for (std::uint32_t in = op + 1; in < end; ++in) {
      if (structure_at(program_.ops[in]) == Structure::Jump && program_.ops[in].target <= in)
        return std::vector<std::optional<ValueRange>>(cells_.size());
      for (std::size_t i = 0; i < cells_.size(); ++i)
        if (drift[i] && writes(in, i)) add_step(drift[i], op, in, i);
    }
    return drift;
  }

  void add_step(std::optional<ValueRange>& drift, std::uint32_t loop, std::uint32_t op, std::size_t cell) const {
    const auto step = step_of(program_, program_.ops[op]);
    const auto box = value_box_of(*program_.ops[op].instruction);
    const auto repeated = repeats(loop, op);
    if (!step || !repeated ||
        cell_of(program_.ops[op][box->to], program_.ops[op].instruction->operand[box->to].width) != cell)
      return drift.reset();
    const std::int64_t added = *step * *repeated;
    drift->least += std::min<std::int64_t>(added, 0);
    drift->most += std::max<std::int64_t>(added, 0);
  }

  /// How often an op is executed at most in a pass of a loop; nothing if a loop in it is not known.
  std::optional<std::int64_t> repeats(std::uint32_t loop, std::uint32_t op) const {
    std::int64_t all = 1;
    for (std::uint32_t inner = loop + 1; inner < op; ++inner) {
      if (!is_for(program_.ops[inner]) || program_.ops[inner].target <= op) continue;
      const Loop& loop_inside = loops_.at(inner);
      if (!loop_inside.reached) return 0;
      if (!loop_inside.passes) return {};
      all *= *loop_inside.passes;
    }
    return all;
  }

  bool writes(std::uint32_t op, std::size_t cell) const {
    if (structure_at(program_.ops[op]) == Structure::Call && writes_[flow_.nodes[program_.ops[op].target].routine][cell] &&
        !is_local_place(cells_[cell].at))
      return true;
    return std::ranges::any_of(effects_[op], [&](const MemoryAccess& access) {
      return access.writes() && !is_local_clearing(access) && access.bits.overlaps(cells_[cell].bits()) &&
             (is_of_operand(access) || structure_at(program_.ops[op]) == Structure::Call);
    });
  }

  // --- blocks ---

  /// A leader is where control may come from elsewhere than from the op in front of it.
  void find_leaders() {
    leads_.assign(program_.ops.size() + 1, false);
    heads_ = leads_;
    leader_of_.assign(program_.ops.size(), 0);
    for (std::uint32_t op = 0; op < program_.ops.size(); ++op) {
      const FlowNode& node = flow_.nodes[op];
      const bool plain = node.next.size() == 1 && node.next.front() == op + 1 && !node.ends &&
                         structure_at(program_.ops[op]) == Structure::None;
      if (!plain) leads_[op + 1] = true;
      for (const std::uint32_t next : node.next) {
        if (next != op + 1) leads_[next] = true;
        if (next <= op) heads_[next] = true;
      }
    }
    for (const Routine& routine : flow_.routines) leads_[routine.first] = heads_[routine.first] = true;
    for (std::uint32_t op = 0, leader = 0; op < program_.ops.size(); ++op)
      leader_of_[op] = leader = leads_[op] ? op : leader;
    reached_.resize(program_.ops.size());
    joins_.assign(program_.ops.size(), 0);
    exits_.resize(flow_.routines.size());
  }

  void begin() {
    Memory first;
    for (const Cell& cell : cells_) {
      first.push_back(!cell.kept || is_set_by_others(cell) ? ValueSet::all_of(cell.width) : before_the_program(cell));
    }
    arrive(flow_.routines[0].first, {first, first});
    for (std::size_t routine = 1; routine < flow_.routines.size(); ++routine) {
      if (calls_.nodes[routine].events.empty()) continue;
      Memory any;
      for (const Cell& cell : cells_) any.push_back(at_any_time(cell));
      arrive(flow_.routines[routine].first, {any, {}});
    }
  }

  /// Memory is 0. What a pointer leads to that the program has not set yet is left out, as in pointers.hpp.
  ValueSet before_the_program(const Cell& cell) const {
    const bool is_pointer = cell.width == Width::Double && pointers_.at_any_time(cell.at);
    return is_pointer ? ValueSet() : ValueSet(0, 0);
  }

  bool is_set_by_others(const Cell& cell) const {
    if (!cell.set_by_name || is_set_by_data_block(program_, cell.bits())) return true;
    if (cell.width != Width::Double || !pointers_.at_any_time(cell.at)) return false;
    const auto unknown = pointers_.unknown(cell.at);
    return unknown && unknown->reason != Pointers::Unknown::Reason::Written;
  }

  ValueSet at_any_time(const Cell& cell) const {
    const auto held = cell.width == Width::Double ? pointers_.at_any_time(cell.at) : std::nullopt;
    return held.value_or(ValueSet::all_of(cell.width));
  }

  static void join(std::optional<Memory>& into, const std::optional<Memory>& from) {
    if (!from) return;
    if (!into) {
      into = from;
      return;
    }
    for (std::size_t i = 0; i < from->size(); ++i) (*into)[i].join((*from)[i]);
  }
  static std::optional<Memory> joined(const State& state) {
    std::optional<Memory> both = state.on;
    join(both, state.off);
    return both;
  }

  void walk_all() {
    for (std::uint32_t leader = 0; leader < program_.ops.size(); ++leader)
      if (reached_[leader].reached()) walk(leader);
  }

  void narrow() {
    phase_ = Phase::FromBelow;
    from_below_.assign(program_.ops.size(), {});
    walking_ = static_cast<std::uint32_t>(program_.ops.size());
    begin();
    walk_all();
    phase_ = Phase::FromAbove;
    reached_ = std::move(from_below_);
    narrowed_exits_.assign(flow_.routines.size(), {});
    walk_all();
    exits_ = std::move(narrowed_exits_);
  }

  /// Adds what comes to a leader, and has it walked again if that is more than before.
  void arrive(std::uint32_t leader, const State& state) {
    if (leader >= program_.ops.size() || phase_ == Phase::Recording) return;
    if (phase_ != Phase::Growing) return arrive_again(leader, state);
    State& at = reached_[leader];
    const int times = heads_[leader] ? joins_[leader] : 0;
    const bool more_on = add(at.on, state.on, times), more_off = add(at.off, state.off, times);
    if (!more_on && !more_off) return;
    ++joins_[leader];
    waiting_.insert(leader);
  }
  void arrive_again(std::uint32_t leader, const State& state) {
    const bool from_below = leader <= walking_;
    if (from_below != (phase_ == Phase::FromBelow)) return;
    State& at = from_below ? from_below_[leader] : reached_[leader];
    join(at.on, state.on);
    join(at.off, state.off);
  }
  void arrive(std::uint32_t leader, const std::optional<Memory>& memory) { arrive(leader, {memory, memory}); }

  /// `times`: how often it has grown so far.
  bool add(std::optional<Memory>& into, const std::optional<Memory>& from, int times) const {
    if (!from) return false;
    if (!into) {
      into = from;
      return true;
    }
    bool more = false;
    for (std::size_t i = 0; i < from->size(); ++i) {
      ValueSet& held = (*into)[i];
      const ValueSet before = held;
      if (!held.join((*from)[i])) continue;
      more = true;
      if (times >= kPatience && held != before && !before.empty())
        held = widened(cells_[i], before, held, times > 3 * kPatience);
    }
    return more;
  }

  /// Ranges that grow go on as far as the program compares, or else as far as pointers to the area may lead. `all`: so do
  /// those that come to others of their area.
  static ValueSet widened(const Cell& cell, const ValueSet& before, const ValueSet& now, bool all) {
    ValueSet wide = now;
    for (const ValueRange& range : now.ranges()) {
      bool grows_up = true, grows_down = true, is_new = true;
      for (const ValueRange& old : before.ranges()) {
        const bool overlaps = old.most >= range.least && old.least <= range.most;
        const bool near = all && old.least / kAreaSize == range.least / kAreaSize;
        if (!overlaps && !near) continue;
        is_new = false;
        grows_up &= range.most > old.most;
        grows_down &= range.least < old.least;
      }
      if (!is_new && grows_up) wide.add({range.most, upper_limit(cell, range.most)});
      if (!is_new && grows_down) wide.add({lower_limit(cell, range.least), range.least});
    }
    return wide.fitted(cell.width);
  }
  static std::int64_t upper_limit(const Cell& cell, std::int64_t value) {
    const std::int64_t end = ((value + kAreaSize / 2 - 1) & -kAreaSize) + kAreaSize / 2;
    const auto limit = cell.compared.lower_bound(value);
    return limit != cell.compared.end() ? std::min(*limit, end) : end;
  }
  static std::int64_t lower_limit(const Cell& cell, std::int64_t value) {
    const std::int64_t end = ((value - kAreaSize / 2) & -kAreaSize) + kAreaSize / 2;
    const auto limit = cell.compared.upper_bound(value);
    return limit != cell.compared.begin() ? std::max(*std::prev(limit), end) : end;
  }
  /// No area has so many bytes: nothing that counts comes through here.
  static bool is_limit(std::int64_t value) { return (value & (kAreaSize - 1)) == kAreaSize / 2; }

  void walk(std::uint32_t leader) {
    walking_ = leader;
    State state = reached_[leader];
    for (std::uint32_t op = leader; op < program_.ops.size(); ++op) {
      if (op != leader && leads_[op]) return arrive(op, state);
      if (flow_.nodes[op].powered) state.off.reset();
      if (!state.reached()) return;
      if (phase_ == Phase::Recording) record(op, state);
      if (leads_on(op, state)) return;
      execute(op, state);
    }
  }

  // --- control ---

  /// Whether the op ends its block: then what follows it has been told.
  bool leads_on(std::uint32_t op, const State& state) {
    const Op& now = program_.ops[op];
    switch (structure_at(now)) {
      case Structure::Jump:
      case Structure::SegmentExit:
        arrive(now.target, state.on);
        arrive(op + 1, state.off);
        return true;
      case Structure::For:
        begin_loop(op, state);
        return true;
      case Structure::Next:
        next_pass(op, joined(state));
        return true;
      case Structure::Call:
        call(op, state);
        return true;
      case Structure::MainEnd:
        end_scan(joined(state));
        return true;
      case Structure::SubroutineEnd:
        leave(op, joined(state));
        return true;
      case Structure::InterruptEnd:
        return true;
      default:
        break;
    }
    if (now.instruction->effect != Effect::ConditionalEnd) return false;
    leave(op, state.on);
    arrive(op + 1, state.off);
    return true;
  }

  void end_scan(std::optional<Memory> memory) {
    if (!memory) return;
    for (std::size_t i = 0; i < cells_.size(); ++i)
      if (!cells_[i].kept) (*memory)[i] = ValueSet::all_of(cells_[i].width);
    arrive(flow_.routines[0].first, memory);
  }

  /// CRET and RET lead back to the callers; END and STOP to the next scan.
  void leave(std::uint32_t op, const std::optional<Memory>& memory) {
    const std::uint32_t routine = flow_.nodes[op].routine;
    const Instruction& instruction = *program_.ops[op].instruction;
    const bool may_end_scan = instruction.structure == Structure::None && instruction.allowed.parts != kSubroutine;
    if (may_end_scan && calls_.nodes[routine].by_main) end_scan(memory);
    if (flow_.routines[routine].kind != Routine::Kind::Subroutine) return;
    if (phase_ == Phase::FromAbove) join(narrowed_exits_[routine], memory);
    if (phase_ != Phase::Growing) return;
    if (!add(exits_[routine], memory, left_[routine]++)) return;
    for (const CallSite& site : flow_.calls)
      if (site.routine == routine && reached_[leader_of_[site.op]].reached()) waiting_.insert(leader_of_[site.op]);
  }

  void call(std::uint32_t op, const State& state) {
    const std::uint32_t callee = flow_.nodes[program_.ops[op].target].routine;
    arrive(flow_.routines[callee].first, {entered(op, state.on), {}});
    arrive(op + 1, {returned(op, callee, state.on), state.off});
  }

  std::span<const Parameter> parameters_of(const Op& call) const {
    return std::span(program_.parameters).subspan(call[1].at, call[2].at);
  }

  std::optional<Memory> entered(std::uint32_t op, const std::optional<Memory>& caller) const {
    if (!caller) return {};
    Memory inside = *caller;
    for (std::size_t i = 0; i < cells_.size(); ++i)
      if (is_local_place(cells_[i].at)) inside[i] = ValueSet::all_of(cells_[i].width);
    for (const Parameter& parameter : parameters_of(program_.ops[op])) {
      const auto local = cell_of(parameter.local, parameter.width);
      if (!local || parameter.role == Role::Out) continue;
      inside[*local] = value_of(op, parameter.actual, parameter.width, *caller);
    }
    return inside;
  }

  std::optional<Memory> returned(std::uint32_t op, std::uint32_t callee, const std::optional<Memory>& caller) const {
    if (!caller || !exits_[callee]) return {};
    Memory after = *caller;
    for (std::size_t i = 0; i < cells_.size(); ++i)
      if (!is_local_place(cells_[i].at) && writes_[callee][i]) after[i] = (*exits_[callee])[i];
    for (const MemoryAccess& access : effects_[op])
      if (access.writes() && !is_local_clearing(access)) overwrite(after, access.bits, op);
    for (const Parameter& parameter : parameters_of(program_.ops[op])) {
      const auto actual = cell_of(parameter.actual, parameter.width), local = cell_of(parameter.local, parameter.width);
      if (actual && local && parameter.role != Role::In) after[*actual] = (*exits_[callee])[*local];
    }
    return after;
  }

  /// Of what is written nothing is known any more.
  void overwrite(Memory& memory, const Bits& bits, std::uint32_t op) const {
    for (std::size_t i = 0; i < cells_.size(); ++i)
      if (bits.overlaps(cells_[i].bits())) memory[i] = ValueSet::all_of(cells_[i].width, op);
  }

  // --- FOR and NEXT ---

  void begin_loop(std::uint32_t op, const State& state) {
    const Op& now = program_.ops[op];
    Loop& loop = loops_[op];
    std::optional<Memory> skipped = state.off;
    if (state.on) {
      const ValueSet first = value_of(op, now[1], Width::Word, *state.on),
                     last = value_of(op, now[2], Width::Word, *state.on);
      Memory done = *state.on;
      set_index(done, op, first);
      const bool surely_runs = !first.empty() && !last.empty() && first.most() <= last.least();
      if (!surely_runs) join(skipped, done);
      count_passes(op, loop, first, last);
      const auto drift_before = loop.drift;
      if (loop.passes.value_or(1) > 0) arrive(op + 1, first_pass(op, loop, *state.on));
      const std::uint32_t next = leader_of_[now.target - 1];
      if (phase_ == Phase::Growing && loop.drift != drift_before && reached_[next].reached()) waiting_.insert(next);
    }
    arrive(now.target, skipped);
  }

  void count_passes(std::uint32_t op, Loop& loop, const ValueSet& first, const ValueSet& last) {
    const auto before = std::pair(loop.reached, loop.passes);
    count_passes(loop, first, last);
    loop.reached = true;
    if (before == std::pair(loop.reached, loop.passes) || phase_ != Phase::Growing) return;
    for (const auto& [outer, about] : loops_)
      if (outer < op && op < program_.ops[outer].target && about.reached) waiting_.insert(leader_of_[outer]);
  }

  static void count_passes(Loop& loop, const ValueSet& first, const ValueSet& last) {
    if (first.empty() || last.empty() || !loop.counts || last.is_all_of(Width::Word)) {
      loop.passes.reset();
      loop.index = ValueSet::all_of(Width::Word);
      return;
    }
    loop.passes = std::max<std::int64_t>(0, last.most() - first.least() + 1);
    loop.index = ValueSet(first.least(), std::max(first.least(), last.most()));
  }

  /// What any pass may find: what it is at first, and what passes before may have added.
  Memory first_pass(std::uint32_t op, Loop& loop, const Memory& before) const {
    Memory inside = before;
    loop.drift = loop.passes ? drift_of(op) : std::vector<std::optional<ValueRange>>(cells_.size());
    for (std::size_t i = 0; loop.passes && i < cells_.size(); ++i) {
      if (!loop.drift[i]) continue;
      const std::int64_t more = *loop.passes - 1;
      inside[i] = counted(inside[i], {loop.drift[i]->least * more, loop.drift[i]->most * more}).fitted(cells_[i].width);
    }
    set_index(inside, op, loop.index);
    return inside;
  }

  void next_pass(std::uint32_t op, std::optional<Memory> memory) {
    const std::uint32_t begin = program_.ops[op].target - 1;
    Loop& loop = loops_[begin];
    if (!memory) return;
    Memory left = *memory;
    set_index(left, begin, loop.index.plus({1, 1}).fitted(Width::Word));
    arrive(op + 1, left);
    set_index(*memory, begin, loop.index);
    for (std::size_t i = 0; i < loop.drift.size(); ++i)
      if (loop.drift[i]) (*memory)[i] = {};  // in what the FOR has told
    arrive(begin + 1, memory);
  }

  void set_index(Memory& memory, std::uint32_t loop, const ValueSet& value) const {
    const Operand& index = program_.ops[loop][0];
    for (const MemoryAccess& access : effects_[loop])
      if (access.writes() && is_of_operand(access)) overwrite(memory, access.bits, loop);
    if (const auto cell = cell_of(index, Width::Word)) memory[*cell] = value;
  }

  // --- boxes and contacts ---

  void execute(std::uint32_t op, State& state) const {
    const Op& now = program_.ops[op];
    if (now.is_contact) return contact(op, state);
    if (now.instruction->rung.stack.change != 0) state.on = state.off = joined(state);
    if (state.on) write(op, *state.on);
    if (state.off && !now.instruction->rung.needs_power_flow) write(op, *state.off);
  }

  void write(std::uint32_t op, Memory& memory) const {
    const Op& now = program_.ops[op];
    const auto box = value_box_of(*now.instruction);
    std::optional<ValueSet> result;
    if (box) result = computed(op, *box, memory);
    for (const MemoryAccess& access : effects_[op]) {
      if (!access.writes() || access.by_pointer || !is_of_operand(access)) continue;
      for (std::size_t i = 0; i < cells_.size(); ++i) {
        if (!access.bits.overlaps(cells_[i].bits())) continue;
        const bool cleared = clears(now) && access.bits.contains(cells_[i].bits());
        const ValueSet written = held_after(op, access, cells_[i], memory[i], result);
        if (access.certainty == Certainty::Must)
          memory[i] = cleared ? ValueSet(0, 0) : written;
        else
          memory[i].join(written);
      }
    }
    for (std::uint8_t i = 0; i < now.instruction->rules().size(); ++i)
      if (now[i].pointer && now.instruction->operand[i].role != Role::In) write_through(op, i, memory);
  }

  bool clears(const Op& op) const {
    return op.instruction->mnemonic == "FILL" && constant_value(program_, op[0], Width::Word) == 0;
  }

  void write_through(std::uint32_t op, std::uint8_t operand, Memory& memory) const {
    const Op& now = program_.ops[op];
    const ValueSet address =
        value_of(op, Operand{.at = now[operand].at, .bit = 0, .pointer = false, .width = 4}, Width::Double, memory);
    for (const PointerTarget& target : places_of(program_, address)) {
      const std::uint64_t reach = reach_of(program_, now, operand, target.from);
      overwrite(memory, {target.from * 8u, (target.to - 1 - target.from) * 8u + reach}, ValueSet::kNoCause);
    }
  }

  ValueSet computed(std::uint32_t op, const ValueBox& box, const Memory& memory) const {
    const Op& now = program_.ops[op];
    const Width width = now.instruction->operand[box.to].width;
    const ValueSet old = value_of(op, now[box.to], width, memory);
    const ValueSet in =
        box.from ? value_of(op, now[*box.from], now.instruction->operand[*box.from].width, memory) : ValueSet(0, 0);
    ValueSet result = result_of(op, box, in, old);
    if (result.is_all_of(Width::Double) && width != Width::Double) result = ValueSet::all_of(width);
    const bool unknown = (box.from && is_unknown(in, now, *box.from)) || in.cause() != ValueSet::kNoCause;
    result = result.fitted(width);
    if (unknown) result.blame(in.cause() != ValueSet::kNoCause ? in.cause() : op);
    if (box.result != carried && old.cause() != ValueSet::kNoCause) result.blame(old.cause());
    return result;
  }
  static bool is_unknown(const ValueSet& in, const Op& op, std::uint8_t operand) {
    return in.is_all_of(op.instruction->operand[operand].width);
  }

  ValueSet result_of(std::uint32_t op, const ValueBox& box, const ValueSet& in, const ValueSet& old) const {
    const auto step = step_of(program_, program_.ops[op]);
    const bool adds = step || box.result == added_up || box.result == taken_off;
    const ValueSet by = step ? ValueSet(*step, *step) : box.result == added_up ? in : in.negated();
    if (!adds || by.empty() || by.least() <= -kAreaSize || by.most() >= kAreaSize) return box.result(in, old);
    ValueSet result;
    for (const ValueRange& range : by.ranges()) result.join(counted(old, range));
    const bool without_end = std::ranges::any_of(
        old.ranges(), [](const ValueRange& range) { return is_limit(range.least) || is_limit(range.most); });
    if (without_end) result.blame(op);
    return result;
  }

  /// Counted on, and not out of its area: for that it would have to go through 16 million addresses that point nowhere.
  static ValueSet counted(const ValueSet& old, const ValueRange& by) {
    ValueSet result;
    for (const ValueRange& range : old.ranges())
      result.add({range.least + (is_limit(range.least) ? 0 : by.least), range.most + (is_limit(range.most) ? 0 : by.most)});
    return result;
  }

  /// What a cell holds after an access to some of it.
  static ValueSet held_after(std::uint32_t op, const MemoryAccess& access, const Cell& cell, const ValueSet& before,
                             const std::optional<ValueSet>& result) {
    const Bits bits = cell.bits();
    const ValueSet any = ValueSet::all_of(cell.width, op);
    if (access.bits == bits) return result.value_or(any);
    if (access.bits.first < bits.first + 8) return any;
    const bool whole = result && access.bits.end() == bits.end();
    const std::int64_t size = std::int64_t{1} << (bits.end() - access.bits.first);
    return with_lower_part(before, size, whole ? *result : ValueSet::all_of(Width::Double, op));
  }

  /// `before` with another number below `size` in its lower bits.
  static ValueSet with_lower_part(const ValueSet& before, std::int64_t size, const ValueSet& part) {
    const bool fits = !part.empty() && part.least() >= 0 && part.most() < size;
    ValueSet result;
    for (const ValueRange& range : before.ranges()) {
      const std::int64_t least = range.least & -size, most = range.most & -size;
      if (least == most && fits)
        result.add({least + part.least(), most + part.most()});
      else
        result.add({least, most + size - 1});
    }
    for (const ValueSet* each : {&before, &part})
      if (each->cause() != ValueSet::kNoCause) result.blame(each->cause());
    return result;
  }

  ValueSet value_of(std::uint32_t op, const Operand& operand, Width width, const Memory& memory) const {
    if (const auto value = constant_value(program_, operand, width)) return {*value, *value};
    if (operand.pointer || operand.unread()) return ValueSet::all_of(width);
    if (const auto cell = cell_of(operand, width)) return seen(op, *cell, memory);
    if (!is_accumulator(operand.at)) return ValueSet::all_of(width);
    const auto whole = number_.find({image::kAC + (operand.at - image::kAC) / 4 * 4, Width::Double});
    if (whole == number_.end()) return ValueSet::all_of(width);
    const ValueSet& value = memory[whole->second];
    return value.fitted(width);
  }

  /// What an op finds in a cell.
  ValueSet seen(std::uint32_t op, std::size_t cell, const Memory& memory) const {
    const bool disturbed = cells_[cell].by_interrupt && calls_.nodes[flow_.nodes[op].routine].by_main;
    return disturbed || cells_[cell].by_system ? at_any_time(cells_[cell]) : memory[cell];
  }

  void contact(std::uint32_t op, State& state) const {
    using Kind = ContactForm::Kind;
    const Op& now = program_.ops[op];
    const std::string_view mnemonic = now.instruction->mnemonic;
    const ContactForm form = contact_form(*now.instruction);
    const std::optional<Memory> both = joined(state);
    if (form.kind == Kind::Not && !now.in_segment) return std::swap(state.on, state.off);
    if (mnemonic == "LPS") return;
    const bool in_series = mnemonic == "ALD" || (form.is_contact() && form.kind != Kind::Not && form.join == Join::And);
    const bool in_parallel = mnemonic == "OLD" || (form.is_contact() && form.join == Join::Or);
    const std::optional<Memory> on = in_series ? state.on : in_parallel ? state.off : both;
    std::optional<Memory> open = in_series ? state.on : in_parallel ? state.off : both, closed = on;
    refine(op, form, true, closed);
    refine(op, form, false, open);
    if (in_parallel) join(closed, state.on);
    if (in_series) join(open, state.off);
    state.on = closed;
    state.off = now.in_segment ? both : open;
  }

  /// Keeps the values with which a comparison holds, or does not.
  void refine(std::uint32_t op, const ContactForm& form, bool holds, std::optional<Memory>& memory) const {
    if (!memory || form.kind != ContactForm::Kind::Numbers || form.type == ContactForm::Type::Real) return;
    const Op& now = program_.ops[op];
    const Width width = now.instruction->operand[0].width;
    const ValueSet first = value_of(op, now[0], width, *memory), second = value_of(op, now[1], width, *memory);
    if (first.empty() || second.empty()) return;
    const Relation relation = holds ? form.relation : opposite(form.relation);
    const ValueSet kept_first = kept(relation, first, second), kept_second = kept(mirrored(relation), second, first);
    if (kept_first.empty() || kept_second.empty()) return memory.reset();
    if (const auto cell = cell_of(now[0], width)) (*memory)[*cell] = kept_first;
    if (const auto cell = cell_of(now[1], width)) (*memory)[*cell] = kept_second;
  }

  static Relation opposite(Relation relation) {
    constexpr std::array kOpposite{Relation::NotEqual, Relation::Equal,        Relation::LessEqual,
                                   Relation::Less,     Relation::GreaterEqual, Relation::Greater};
    return kOpposite[static_cast<std::size_t>(relation)];
  }
  static Relation mirrored(Relation relation) {
    constexpr std::array kMirrored{Relation::Equal,     Relation::NotEqual, Relation::Less,
                                   Relation::LessEqual, Relation::Greater,  Relation::GreaterEqual};
    return kMirrored[static_cast<std::size_t>(relation)];
  }

  /// The numbers of `values` that have the relation with some number of `others`.
  static ValueSet kept(Relation relation, const ValueSet& values, const ValueSet& others) {
    const std::int64_t least = values.least(), most = values.most();
    switch (relation) {
      case Relation::Equal:
        return values.within(others.least(), others.most());
      case Relation::NotEqual: {
        if (!others.single()) return values;
        ValueSet below = values.within(least, *others.single() - 1);
        below.join(values.within(*others.single() + 1, most));
        return below;
      }
      case Relation::Greater:
        return values.within(others.least() + 1, most);
      case Relation::GreaterEqual:
        return values.within(others.least(), most);
      case Relation::Less:
        return values.within(least, others.most() - 1);
      case Relation::LessEqual:
        return values.within(least, others.most());
    }
    return values;
  }

  // --- what was asked for ---

  void record(std::uint32_t op, const State& state) {
    const Op& now = program_.ops[op];
    const std::optional<Memory> memory = now.instruction->rung.needs_power_flow ? state.on : joined(state);
    if (!memory) return;
    const auto note = [&](const Operand& operand) {
      if (!operand.pointer) return;
      const auto cell = number_.find({operand.at, Width::Double});
      if (cell != number_.end()) result_.pointers_[{op, operand.at}] = seen(op, cell->second, *memory);
    };
    for (const Operand& operand : now.operand) note(operand);
    if (structure_at(now) == Structure::Call)
      for (const Parameter& parameter : parameters_of(now)) note(parameter.actual);
    if (is_for(now) && loops_[op].passes) result_.passes_[op] = *loops_[op].passes;
  }

  const Program& program_;
  const ControlFlow& flow_;
  const std::vector<std::vector<MemoryAccess>>& effects_;
  const Pointers& pointers_;
  Calls calls_;
  ReachingValues& result_;

  std::vector<Cell> cells_{};
  std::map<std::pair<std::uint32_t, Width>, std::size_t> number_{};  // of a cell, by place
  std::vector<std::vector<bool>> direct_{}, writes_{};               // by routine and cell: itself, and with what it calls
  std::map<std::uint32_t, Loop> loops_{};                            // by FOR
  std::vector<bool> leads_{}, heads_{};                              // by op: begins a block; may be reached from below
  std::vector<std::uint32_t> leader_of_{};                           // by op
  std::vector<State> reached_{};                                     // by leader
  std::vector<int> joins_{};                                         // by leader
  std::vector<std::optional<Memory>> exits_{};                       // by routine
  std::map<std::uint32_t, int> left_{};                              // by routine
  std::set<std::uint32_t> waiting_{};
  Phase phase_ = Phase::Growing;
  std::uint32_t walking_ = 0;                            // the leader
  std::vector<State> from_below_{};                      // by leader: what loops, calls and the scan before bring
  std::vector<std::optional<Memory>> narrowed_exits_{};  // by routine
};

ReachingValues::ReachingValues(const Program& program, const ControlFlow& flow,
                               const std::vector<std::vector<MemoryAccess>>& effects, const Pointers& pointers) {
  ValueFollower(program, flow, effects, pointers, *this).follow();
}

std::optional<ValueSet> ReachingValues::pointer(std::uint32_t op, std::uint32_t at) const {
  const auto found = pointers_.find({op, at});
  return found == pointers_.end() ? std::nullopt : std::optional(found->second);
}

std::optional<std::int64_t> ReachingValues::passes(std::uint32_t op) const {
  const auto found = passes_.find(op);
  return found == passes_.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace s7200
