#include "interpreter/analysis/effects/reaching_values.hpp"

#include <algorithm>
#include <set>
#include <span>
#include <string_view>
#include <tuple>

#include "interpreter/analysis/cross_reference.hpp"
#include "interpreter/analysis/effects/effects.hpp"
#include "interpreter/analysis/effects/followed_cells.hpp"
#include "interpreter/analysis/effects/pointers.hpp"
#include "interpreter/analysis/effects/value_boxes.hpp"
#include "interpreter/model/contact_form.hpp"

namespace s7200 {
namespace {

constexpr int kNarrowings = 2;
constexpr std::size_t kMostFollowed = 3'000'000;  ///< cells in front of blocks, about 1 GB: nothing is known of more
constexpr int kPatience = 4;                      ///< times that a value may grow where ways meet before it is widened

Structure structure_at(const Op& op) { return op.instruction->structure; }

bool is_for(const Op& op) { return structure_at(op) == Structure::For; }

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
                const Pointers& pointers, const Waiter& waiter, ReachingValues& result)
      : program_(program),
        flow_(flow),
        effects_(effects),
        pointers_(pointers),
        waiter_(waiter),
        calls_(calls_of(program, flow)),
        cells_(program, flow, effects, pointers, calls_),
        result_(result) {}

  void follow() {
    if (cells_.empty()) return;
    find_leaders();
    if (static_cast<std::size_t>(std::ranges::count(leads_, true)) * cells_.size() > kMostFollowed) return;
    find_loops();
    begin();
    while (!waiting_.empty()) {
      if (waiter_.asks_to_end()) return;
      const std::uint32_t leader = *waiting_.begin();
      waiting_.erase(waiting_.begin());
      walk(leader);
    }
    for (int round = 0; round < kNarrowings; ++round) {
      if (waiter_.asks_to_end()) return;
      narrow();
    }
    phase_ = Phase::Recording;
    walk_all();
  }

 private:
  /// Values first grow until nothing changes. Where loops made them grow too far, they are worked out again from what comes
  /// from below, which is known by then.
  enum class Phase : std::uint8_t { Growing, FromBelow, FromAbove, Recording };

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
    bool surely_all = false;               ///< it makes no fewer
    ValueSet index{};                      ///< during the passes
    /// By cell: what it holds after the last pass, if each pass surely adds the same.
    std::vector<std::optional<ValueSet>> after{};
  };

  // --- loops ---

  void find_loops() {
    for (std::uint32_t op = 0; op < program_.ops.size(); ++op) {
      if (!is_for(program_.ops[op])) continue;
      Loop& loop = loops_[op];
      loop.counts = counts_its_passes(flow_, program_, effects_, op) && !changes_elsewhere(program_.ops[op][0]);
    }
  }
  bool changes_elsewhere(const Operand& index) const {
    const auto cell = cells_.of(index, Width::Word);
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
        cells_.of(program_.ops[op][box->to], program_.ops[op].instruction->operand[box->to].width) != cell)
      return drift.reset();
    const std::int64_t added = *step * *repeated;
    drift->least += std::min<std::int64_t>(added, 0);
    drift->most += std::max<std::int64_t>(added, 0);
  }

  /// What each pass of a loop surely adds to a cell: all that writes it counts it, always has power flow, and nothing jumps.
  std::optional<std::int64_t> sure_step_of(std::uint32_t loop, std::size_t cell) const {
    std::int64_t step = 0;
    for (std::uint32_t op = loop + 1; op + 1 < program_.ops[loop].target; ++op) {
      const Structure structure = structure_at(program_.ops[op]);
      if (structure == Structure::Label || structure == Structure::Jump || structure == Structure::SegmentExit) return {};
      if (!writes(op, cell)) continue;
      const auto repeated = repeats(loop, op);
      if (!repeated || !flow_.nodes[op].powered || program_.ops[op].in_segment || !surely_repeats(loop, op)) return {};
      step += step_of(program_, program_.ops[op]).value_or(0) * *repeated;
    }
    return step;
  }

  bool surely_repeats(std::uint32_t loop, std::uint32_t op) const {
    return std::ranges::all_of(loops_, [&](const auto& each) {
      const auto& [inner, about] = each;
      const bool around = inner > loop && inner < op && op < program_.ops[inner].target;
      return !around || (about.surely_all && flow_.nodes[inner].powered);
    });
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
    if (structure_at(program_.ops[op]) == Structure::Call &&
        cells_.written_in(flow_.nodes[program_.ops[op].target].routine, cell) && !is_local_place(cells_[cell].at))
      return true;
    if (const auto led = led_to_.find(op); led != led_to_.end() && led->second[cell]) return true;
    return std::ranges::any_of(effects_[op], [&](const MemoryAccess& access) {
      return access.writes() && !is_local_clearing(access) && access.bits.overlaps(cells_[cell].bits()) &&
             !is_walked(op, access) && (is_of_operand(access) || structure_at(program_.ops[op]) == Structure::Call);
    });
  }

  /// What is written through a pointer is where it leads as far as followed, not wherever it may lead at any time: that may
  /// be itself, and then nothing would bound it.
  bool is_walked(std::uint32_t op, const MemoryAccess& access) const {
    return access.by_pointer && access.operand != kNoOperand && structure_at(program_.ops[op]) == Structure::None;
  }

  /// Works the loops around an op out again if its pointers lead to more cells than before.
  void note_led_to(std::uint32_t op, const Bits& bits) {
    auto& led_to = led_to_.try_emplace(op, cells_.size()).first->second;
    bool more = false;
    for (std::size_t i = 0; i < cells_.size(); ++i)
      if (bits.overlaps(cells_[i].bits()) && !led_to[i]) more = led_to[i] = true;
    if (!more || phase_ != Phase::Growing) return;
    for (const auto& [loop, about] : loops_)
      if (loop < op && op < program_.ops[loop].target && about.reached) waiting_.insert(leader_of_[loop]);
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
    for (const FollowedCell& cell : cells_) {
      first.push_back(!cell.kept || is_set_by_others(cell) ? ValueSet::all_of(cell.width) : before_the_program(cell));
    }
    arrive(flow_.routines[0].first, {first, first});
    for (std::size_t routine = 1; routine < flow_.routines.size(); ++routine) {
      if (calls_.nodes[routine].events.empty()) continue;
      Memory any;
      for (const FollowedCell& cell : cells_) any.push_back(at_any_time(cell));
      arrive(flow_.routines[routine].first, {any, {}});
    }
  }

  /// Memory is 0. What a pointer leads to that the program has not set yet is left out, as in pointers.hpp.
  ValueSet before_the_program(const FollowedCell& cell) const {
    const bool is_pointer = cell.width == Width::Double && pointers_.at_any_time(cell.at);
    return is_pointer ? ValueSet() : ValueSet(0, 0);
  }

  bool is_set_by_others(const FollowedCell& cell) const {
    if (!cell.set_by_name || is_set_by_data_block(program_, cell.bits())) return true;
    if (cell.width != Width::Double || !pointers_.at_any_time(cell.at)) return false;
    const auto unknown = pointers_.unknown(cell.at);
    return unknown && unknown->reason != Pointers::Unknown::Reason::Written;
  }

  ValueSet at_any_time(const FollowedCell& cell) const {
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
      const auto local = cells_.of(parameter.local, parameter.width);
      if (!local || parameter.role == Role::Out) continue;
      inside[*local] = value_of(op, parameter.actual, parameter.width, *caller);
    }
    return inside;
  }

  std::optional<Memory> returned(std::uint32_t op, std::uint32_t callee, const std::optional<Memory>& caller) const {
    if (!caller || !exits_[callee]) return {};
    Memory after = *caller;
    for (std::size_t i = 0; i < cells_.size(); ++i)
      if (!is_local_place(cells_[i].at) && cells_.written_in(callee, i)) after[i] = (*exits_[callee])[i];
    for (const MemoryAccess& access : effects_[op])
      if (access.writes() && !is_local_clearing(access)) overwrite(after, access.bits, op);
    for (const Parameter& parameter : parameters_of(program_.ops[op])) {
      const auto actual = cells_.of(parameter.actual, parameter.width), local = cells_.of(parameter.local, parameter.width);
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
      const auto before = std::pair(loop.drift, loop.after);
      if (loop.passes.value_or(1) > 0) arrive(op + 1, first_pass(op, loop, *state.on));
      const std::uint32_t next = leader_of_[now.target - 1];
      const bool more = before != std::pair(loop.drift, loop.after);
      if (phase_ == Phase::Growing && more && reached_[next].reached()) waiting_.insert(next);
    }
    arrive(now.target, skipped);
  }

  void count_passes(std::uint32_t op, Loop& loop, const ValueSet& first, const ValueSet& last) {
    const auto before = std::tuple(loop.reached, loop.passes, loop.surely_all);
    count_passes(loop, first, last);
    loop.reached = true;
    if (before == std::tuple(loop.reached, loop.passes, loop.surely_all) || phase_ != Phase::Growing) return;
    for (const auto& [outer, about] : loops_)
      if (outer < op && op < program_.ops[outer].target && about.reached) waiting_.insert(leader_of_[outer]);
  }

  static void count_passes(Loop& loop, const ValueSet& first, const ValueSet& last) {
    if (first.empty() || last.empty() || !loop.counts || last.is_all_of(Width::Word)) {
      loop.passes.reset();
      loop.surely_all = false;
      loop.index = ValueSet::all_of(Width::Word);
      return;
    }
    loop.surely_all = first.single() && last.single();
    loop.passes = std::max<std::int64_t>(0, last.most() - first.least() + 1);
    loop.index = ValueSet(first.least(), std::max(first.least(), last.most()));
  }

  /// What any pass may find: what it is at first, and what passes before may have added.
  Memory first_pass(std::uint32_t op, Loop& loop, const Memory& before) const {
    Memory inside = before;
    loop.drift = loop.passes ? drift_of(op) : std::vector<std::optional<ValueRange>>(cells_.size());
    loop.after = after_all_passes(op, loop, before);
    for (std::size_t i = 0; loop.passes && i < cells_.size(); ++i) {
      if (!loop.drift[i]) continue;
      const std::int64_t more = *loop.passes - 1;
      inside[i] = counted_on(inside[i], {loop.drift[i]->least * more, loop.drift[i]->most * more}).fitted(cells_[i].width);
    }
    set_index(inside, op, loop.index);
    return inside;
  }

  std::vector<std::optional<ValueSet>> after_all_passes(std::uint32_t op, const Loop& loop, const Memory& before) const {
    std::vector<std::optional<ValueSet>> after(cells_.size());
    for (std::size_t i = 0; loop.surely_all && i < cells_.size(); ++i) {
      if (!loop.drift[i] || *loop.drift[i] == ValueRange{}) continue;
      const auto step = sure_step_of(op, i);
      if (step) after[i] = counted_on(before[i], {*step * *loop.passes, *step * *loop.passes}).fitted(cells_[i].width);
    }
    return after;
  }

  void next_pass(std::uint32_t op, std::optional<Memory> memory) {
    const std::uint32_t begin = program_.ops[op].target - 1;
    Loop& loop = loops_[begin];
    if (!memory) return;
    Memory left = *memory;
    for (std::size_t i = 0; i < loop.after.size(); ++i)
      if (loop.after[i]) left[i] = *loop.after[i];
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
    if (const auto cell = cells_.of(index, Width::Word)) memory[*cell] = value;
  }

  // --- boxes and contacts ---

  void execute(std::uint32_t op, State& state) {
    const Op& now = program_.ops[op];
    if (now.is_contact) return contact(op, state);
    if (now.instruction->rung.stack.change != 0) state.on = state.off = joined(state);
    if (state.on) write(op, *state.on);
    if (state.off && !now.instruction->rung.needs_power_flow) write(op, *state.off);
  }

  void write(std::uint32_t op, Memory& memory) {
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

  void write_through(std::uint32_t op, std::uint8_t operand, Memory& memory) {
    const Op& now = program_.ops[op];
    const ValueSet address =
        value_of(op, Operand{.at = now[operand].at, .bit = 0, .pointer = false, .width = 4}, Width::Double, memory);
    for (const PointerTarget& target : places_of(program_, address)) {
      const std::uint64_t reach = reach_of(program_, now, operand, target.from);
      const Bits written{target.from * 8u, (target.to - 1 - target.from) * 8u + reach};
      overwrite(memory, written, ValueSet::kNoCause);
      note_led_to(op, written);
    }
  }

  ValueSet computed(std::uint32_t op, const ValueBox& box, const Memory& memory) const {
    const Op& now = program_.ops[op];
    const Width width = now.instruction->operand[box.to].width;
    const ValueSet old = value_of(op, now[box.to], width, memory);
    const ValueSet in =
        box.from ? value_of(op, now[*box.from], now.instruction->operand[*box.from].width, memory) : ValueSet(0, 0);
    ValueSet result = result_of(program_, op, box, in, old);
    if (result.is_all_of(Width::Double) && width != Width::Double) result = ValueSet::all_of(width);
    const bool unknown = (box.from && is_unknown(in, now, *box.from)) || in.cause() != ValueSet::kNoCause;
    result = result.fitted(width);
    if (unknown) result.blame(in.cause() != ValueSet::kNoCause ? in.cause() : op);
    if (!box.carries() && old.cause() != ValueSet::kNoCause) result.blame(old.cause());
    return result;
  }
  static bool is_unknown(const ValueSet& in, const Op& op, std::uint8_t operand) {
    return in.is_all_of(op.instruction->operand[operand].width);
  }

  /// What a cell holds after an access to some of it.
  static ValueSet held_after(std::uint32_t op, const MemoryAccess& access, const FollowedCell& cell, const ValueSet& before,
                             const std::optional<ValueSet>& result) {
    const Bits bits = cell.bits();
    const ValueSet any = ValueSet::all_of(cell.width, op);
    if (access.bits == bits) return result.value_or(any);
    if (access.bits.first < bits.first + 8) return any;
    const bool whole = result && access.bits.end() == bits.end();
    const std::int64_t size = std::int64_t{1} << (bits.end() - access.bits.first);
    return with_lower_part(before, size, whole ? *result : ValueSet::all_of(Width::Double, op));
  }

  ValueSet value_of(std::uint32_t op, const Operand& operand, Width width, const Memory& memory) const {
    if (const auto value = constant_value(program_, operand, width)) return {*value, *value};
    if (operand.pointer || operand.unread()) return ValueSet::all_of(width);
    if (const auto cell = cells_.of(operand, width)) return seen(op, *cell, memory);
    if (!is_accumulator(operand.at)) return ValueSet::all_of(width);
    const auto whole = cells_.at(image::kAC + (operand.at - image::kAC) / 4 * 4, Width::Double);
    return whole ? memory[*whole].fitted(width) : ValueSet::all_of(width);
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
    const ValueSet kept_first = first.that_are(relation, second), kept_second = second.that_are(mirrored(relation), first);
    if (kept_first.empty() || kept_second.empty()) return memory.reset();
    if (const auto cell = cells_.of(now[0], width)) (*memory)[*cell] = kept_first;
    if (const auto cell = cells_.of(now[1], width)) (*memory)[*cell] = kept_second;
  }

  // --- what was asked for ---

  void record(std::uint32_t op, const State& state) {
    const Op& now = program_.ops[op];
    const std::optional<Memory> memory = now.instruction->rung.needs_power_flow ? state.on : joined(state);
    if (!memory) return;
    const auto note = [&](const Operand& operand) {
      if (!operand.pointer) return;
      const auto cell = cells_.at(operand.at, Width::Double);
      if (cell) result_.pointers_[{op, operand.at}] = seen(op, *cell, *memory);
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
  const Waiter& waiter_;
  Calls calls_;
  FollowedCells cells_;
  ReachingValues& result_;

  std::map<std::uint32_t, Loop> loops_{};                // by FOR
  std::vector<bool> leads_{}, heads_{};                  // by op: begins a block; may be reached from below
  std::vector<std::uint32_t> leader_of_{};               // by op
  std::vector<State> reached_{};                         // by leader
  std::vector<int> joins_{};                             // by leader
  std::vector<std::optional<Memory>> exits_{};           // by routine
  std::map<std::uint32_t, int> left_{};                  // by routine
  std::map<std::uint32_t, std::vector<bool>> led_to_{};  // by op: the cells that its pointers lead to
  std::set<std::uint32_t> waiting_{};
  Phase phase_ = Phase::Growing;
  std::uint32_t walking_ = 0;                            // the leader
  std::vector<State> from_below_{};                      // by leader: what loops, calls and the scan before bring
  std::vector<std::optional<Memory>> narrowed_exits_{};  // by routine
};

ReachingValues::ReachingValues(const Program& program, const ControlFlow& flow,
                               const std::vector<std::vector<MemoryAccess>>& effects, const Pointers& pointers,
                               const Waiter& waiter) {
  ValueFollower(program, flow, effects, pointers, waiter, *this).follow();
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
