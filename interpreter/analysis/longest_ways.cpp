#include "interpreter/analysis/longest_ways.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <map>
#include <string_view>

#include "interpreter/analysis/cross_reference.hpp"
#include "interpreter/analysis/effects/followed_cells.hpp"
#include "interpreter/analysis/effects/reaching_values.hpp"
#include "interpreter/analysis/effects/value_boxes.hpp"
#include "interpreter/analysis/way_cells.hpp"
#include "interpreter/model/contact_form.hpp"

namespace s7200 {
namespace {

constexpr std::int64_t kMostUnits = 255;  ///< units of an instruction that memory counts: bytes, characters, entries
constexpr std::int64_t kMostShifted = 32;
constexpr std::size_t kMostWays = 1000, kFewWays = 40;      ///< in front of an op
constexpr std::uint64_t kManySteps = 100'000;               ///< after which few ways must do
constexpr std::uint64_t kMuchKept = 2'000'000;              ///< values of cells that are kept, about 200 MB: the same
constexpr Bits kSumOverflow{(image::kSM + 1) * 8u + 1, 1};  ///< SM1.1
constexpr int kLevels = 9;                                  ///< of the logic stack

Structure flow_role(const Op& op) { return op.instruction->structure; }

/// The levels of the logic stack on a way, the top first.
class StackOfWay {
 public:
  explicit StackOfWay(unsigned bits = 0) : bits_(bits & ((1u << kLevels) - 1)) {}
  unsigned bits() const { return bits_; }
  bool top() const { return level(0); }
  bool level(unsigned number) const { return (bits_ >> number & 1) != 0; }
  void push(bool value) { *this = StackOfWay(bits_ << 1 | (value ? 1u : 0u)); }
  void pop() { bits_ >>= 1; }
  void set_top(bool value) { bits_ = (bits_ & ~1u) | (value ? 1u : 0u); }

  bool operator==(const StackOfWay&) const = default;

 private:
  unsigned bits_;
};

/// The logic stack, and what is known of memory, in front of an op.
struct Way {
  StackOfWay stack{};
  WayMemory memory{};
  Time time = 0;
};

using WayList = std::vector<Way>;

/// Takes the shortest two ways with the same stack for one. False if there are none.
bool join_the_shortest(WayList& ways) {
  std::ranges::stable_sort(ways, {}, &Way::time);
  for (std::size_t i = 0; i < ways.size(); ++i)
    for (std::size_t other = i + 1; other < ways.size(); ++other) {
      if (ways[other].stack != ways[i].stack) continue;
      ways[i].memory.join(ways[other].memory);
      ways[i].time = ways[other].time;
      ways.erase(ways.begin() + static_cast<std::ptrdiff_t>(other));
      return true;
    }
  return false;
}

void add_way(WayList& ways, Way way, std::size_t most) {
  const auto same =
      std::ranges::find_if(ways, [&](const Way& each) { return each.stack == way.stack && each.memory == way.memory; });
  if (same != ways.end()) {
    same->time = std::max(same->time, way.time);
    return;
  }
  ways.push_back(std::move(way));
  while (ways.size() > most && join_the_shortest(ways)) {
  }
}

/// How deep the logic stack is looked at from each op of a routine on.
class StackNeeds {
 public:
  StackNeeds(const ControlFlow& flow, const Program& program)
      : flow_(flow), program_(program), needs_(program.ops.size(), 0) {
    for (bool changed = true; changed;) {
      changed = false;
      for (std::uint32_t op = static_cast<std::uint32_t>(needs_.size()); op-- > 0;) {
        const int need = before(op);
        changed |= need != needs_[op];
        needs_[op] = need;
      }
    }
  }

  StackOfWay kept(std::uint32_t op, StackOfWay stack) const {
    const int need = op < needs_.size() ? needs_[op] : 0;
    return StackOfWay(stack.bits() & ((1u << need) - 1));
  }

 private:
  int before(std::uint32_t op) const {
    const Op& now = program_.ops[op];
    const StackUse& use = now.instruction->rung.stack;
    int after = 0;
    for (const std::uint32_t next : flow_.nodes[op].next) after = std::max(after, needs_[next]);
    if (now.instruction->mnemonic == "LDS") return kLevels;
    const int uses = std::max<int>(use.needs, now.power_mask != 0 ? std::bit_width(now.power_mask) : 0);
    return std::min(kLevels, std::max({uses, after - use.change, 0}));
  }

  const ControlFlow& flow_;
  const Program& program_;
  std::vector<int> needs_;
};

}  // namespace

/// Answers one question.
class LongestWays::Follower {
 public:
  Follower(const LongestWays& of, const Assumed& assumed)
      : facts_(of.facts_),
        timed_(of.timed_),
        times_(of.times_),
        waiter_(of.waiter_),
        assumed_(assumed),
        cells_(of.facts_, assumed.disturbing),
        needs_(of.facts_.flow, of.timed_) {}

  LongestWay of_routine(std::uint32_t routine) {
    const Through through = through_routine(routine, cells_.nothing_known());
    return finish(through);
  }

  LongestWay of_stretch(std::uint32_t from, std::uint32_t to) {
    Through through;
    WayList all;
    for (unsigned top = 0; top < 2; ++top) {
      all.push_back({StackOfWay(top), cells_.nothing_known(), 0});
    }
    for (const auto& [op, ways] : walk(from, to, std::move(all), through)) take(through.exits, ways);
    return finish(through);
  }

 private:
  /// What comes of a routine, or of a stretch of it, that begins at time 0.
  struct Through {
    WayList exits{};  ///< where it returns
    std::optional<Time> ends{}, to_transmission{};
    Time instruction = 0;                            ///< the longest
    std::set<std::uint32_t> loops{};                 ///< without a bound
    std::map<std::uint32_t, std::int64_t> passes{};  ///< of those with a bound
    void count(std::uint32_t loop, std::int64_t most) {
      auto& known = passes[loop];
      known = std::max(known, most);
    }
    void end_at(Time time) { ends = std::max(ends.value_or(0), time); }
    void include(const Through& part) {
      instruction = std::max(instruction, part.instruction);
      loops.insert(part.loops.begin(), part.loops.end());
      for (const auto& [loop, most] : part.passes) count(loop, most);
    }
    void transmit_at(Time time) { to_transmission = std::max(to_transmission.value_or(0), time); }
  };
  struct Entry {
    std::uint32_t routine = 0;
    WayMemory memory{};
    Through through{};
  };
  using Arrivals = std::map<std::uint32_t, WayList>;  // by op outside of a stretch

  LongestWay finish(const Through& through) const {
    LongestWay way{through.ends.value_or(0), through.to_transmission, through.instruction, through.loops, through.passes};
    for (const Way& exit : through.exits) way.time = std::max(way.time, exit.time);
    return way;
  }

  void take(WayList& into, const WayList& from) const {
    for (const Way& way : from) add_way(into, way, most_ways());
  }

  Through through_routine(std::uint32_t routine, WayMemory memory) {
    cells_.forget_dead(memory, facts_.flow.routines[routine].first);
    for (const Entry& entry : known_)
      if (entry.routine == routine && entry.memory == memory) return entry.through;
    const Routine& of = facts_.flow.routines[routine];
    Through through;
    under_way_.insert(routine);
    for (auto& [op, ways] : walk(of.first, of.end, {{StackOfWay(1), memory, 0}}, through)) take(through.exits, ways);
    under_way_.erase(routine);
    known_.push_back({routine, memory, through});
    kept_ += (1 + through.exits.size()) * memory.value.size();
    return through;
  }

  /// Follows ways from `from` on. What leaves [from, to) is returned by where it leads.
  Arrivals walk(std::uint32_t from, std::uint32_t to, WayList first, Through& through) {
    Arrivals arrivals;
    arrivals[from] = std::move(first);
    for (std::uint32_t op = from; op < to; ++op) {
      const auto here = arrivals.extract(op);
      if (here.empty()) continue;
      for (const Way& way : here.mapped()) {
        if (waiter_.asks_to_end()) return {};
        step(op, way, from, arrivals, through);
      }
    }
    return arrivals;
  }

  void arrive(std::uint32_t op, Way way, Arrivals& arrivals) const {
    way.stack = needs_.kept(op, way.stack);
    cells_.forget_dead(way.memory, op);
    add_way(arrivals[op], std::move(way), most_ways());
  }

  /// After many steps, calls and loops are followed as if nothing were known in front of them: each once.
  std::size_t most_ways() const { return has_patience() ? kMostWays : kFewWays; }
  bool has_patience() const { return steps_ < kManySteps && kept_ < kMuchKept; }

  // --- an op ---

  void step(std::uint32_t op, Way way, std::uint32_t from, Arrivals& arrivals, Through& through) {
    const Op& now = timed_.ops[op];
    ++steps_;
    if (now.is_contact) return contact(op, std::move(way), arrivals, through);
    const bool powered = (now.power_mask & ~way.stack.bits()) == 0;
    const Time cost = powered ? now.cost + unit_time(now, way.memory) : timed_.no_power_flow;
    through.instruction = std::max(through.instruction, cost);
    way.time += cost;
    if (now.instruction->effect == Effect::Transmits && powered && now[1].at == assumed_.port) through.transmit_at(way.time);
    switch (flow_role(now)) {
      case Structure::Jump:
        return powered ? jump(op, std::move(way), from, arrivals, through) : arrive(op + 1, std::move(way), arrivals);
      case Structure::SegmentExit:
        return arrive(powered ? now.target : op + 1, std::move(way), arrivals);
      case Structure::For:
        return powered ? run_loop(op, std::move(way), arrivals, through) : arrive(now.target, std::move(way), arrivals);
      case Structure::Call:
        if (powered) return call(op, way, arrivals, through);
        return arrive(op + 1, std::move(way), arrivals);
      case Structure::MainEnd:
      case Structure::SubroutineEnd:
      case Structure::InterruptEnd:
        return return_from(op, std::move(way), through);
      case Structure::SegmentBegin:
        for (const std::uint32_t next : facts_.flow.nodes[op].next)
          if (next > op) arrive(next, way, arrivals);
        return;
      default:
        break;
    }
    if (now.instruction->effect == Effect::ConditionalEnd && powered) return end(op, std::move(way), through);
    if (powered || !now.instruction->rung.needs_power_flow) write(op, way);
    const int popped = -now.instruction->rung.stack.change;
    for (int i = 0; i < popped; ++i) way.stack.pop();
    arrive(op + 1, std::move(way), arrivals);
  }

  void return_from(std::uint32_t op, Way way, Through& through) const {
    way.stack = StackOfWay();
    cells_.forget_dead_after(way.memory, facts_.flow.nodes[op].routine);
    add_way(through.exits, std::move(way), most_ways());
  }

  /// CRET and CRETI return; END and STOP end the scan.
  void end(std::uint32_t op, Way way, Through& through) const {
    if (timed_.ops[op].instruction->mnemonic.starts_with("CRET")) return return_from(op, std::move(way), through);
    through.end_at(way.time);
  }

  std::int64_t units(const Op& op, const WayMemory& memory) const {
    const std::string_view name = op.instruction->mnemonic;
    const bool shifts = name.starts_with("SL") || name.starts_with("SR") || name.starts_with("RL") || name.starts_with("RR");
    const auto rules = op.instruction->rules();
    for (std::size_t i = 0; i < rules.size(); ++i) {
      if (!rules[i].count && !(shifts && rules[i].role == Role::In)) continue;
      if (const auto constant = constant_value(timed_, op[i], Width::Byte))
        return rules[i].sign == Sign::Signed ? std::abs(static_cast<std::int8_t>(*constant)) : *constant;
      const ValueSet count = cells_.value_of(timed_, op[i], Width::Byte, memory);
      return std::min(shifts ? kMostShifted : kMostUnits, count.empty() ? kMostUnits : count.most());
    }
    return shifts ? kMostShifted : kMostUnits;
  }
  Time unit_time(const Op& op, const WayMemory& memory) const {
    return op.unit_cost == 0 ? 0 : op.unit_cost * units(op, memory);
  }

  // --- contacts ---

  void contact(std::uint32_t op, Way way, Arrivals& arrivals, Through& through) const {
    const Op& now = timed_.ops[op];
    const std::string_view mnemonic = now.instruction->mnemonic;
    const bool top = way.stack.top();
    through.instruction = std::max<Time>(through.instruction, now.cost);
    way.time += now.cost;
    if (mnemonic == "ALD" || mnemonic == "OLD") {
      way.stack.pop();
      way.stack.set_top(mnemonic == "ALD" ? way.stack.top() && top : way.stack.top() || top);
    } else if (mnemonic == "LPS") {
      way.stack.push(top);
    } else if (mnemonic == "LRD") {
      way.stack.set_top(way.stack.level(1));
    } else if (mnemonic == "LPP") {
      way.stack.pop();
    } else if (mnemonic == "LDS") {
      way.stack.push(way.stack.level(now[0].at));
    } else {
      return look(op, contact_form(*now.instruction), std::move(way), arrivals);
    }
    arrive(op + 1, std::move(way), arrivals);
  }

  void look(std::uint32_t op, const ContactForm& form, Way way, Arrivals& arrivals) const {
    using Kind = ContactForm::Kind;
    const bool top = way.stack.top();
    if (form.kind == Kind::Not) {
      way.stack.set_top(!top);
      if (timed_.ops[op].in_segment) arrive_with(op, false, way, arrivals);
      return arrive(op + 1, std::move(way), arrivals);
    }
    const bool decided = form.is_edge() || form.kind == Kind::Eno ? !top
                         : form.join == Join::And                 ? !top
                                                                  : form.join == Join::Or && top;
    if (decided) return arrive(op + 1, std::move(way), arrivals);
    for (const bool closed : {false, true}) {
      WayMemory memory = way.memory;
      if (!may_be(op, form, closed, memory)) continue;
      Way next{way.stack, std::move(memory), way.time};
      if (form.is_contact() && !form.is_edge() && form.kind != Kind::Eno && form.join == Join::Load)
        next.stack.push(closed);
      else
        next.stack.set_top(closed);
      arrive(op + 1, std::move(next), arrivals);
    }
  }
  void arrive_with(std::uint32_t op, bool top, Way way, Arrivals& arrivals) const {
    way.stack.set_top(top);
    arrive(op + 1, std::move(way), arrivals);
  }

  /// Whether a contact may be closed, or open; then `memory` is as it is so.
  bool may_be(std::uint32_t op, const ContactForm& form, bool closed, WayMemory& memory) const {
    using Kind = ContactForm::Kind;
    const Op& now = timed_.ops[op];
    if (now.in_segment && !closed) return true;  // the rail may be off
    if (form.kind == Kind::Bit) {
      if (now[0].pointer) return true;
      const Bits bit{now[0].at * 8u + now[0].bit, 1};
      const bool on = closed != form.inverted;
      for (const auto& [assumed, value] : assumed_.bits)
        if (assumed == bit) return value == on;
      if (bit == Bits{image::kSM * 8u, 1}) return on;  // SM0.0
      if (bit == kSumOverflow && !on) cells_.note_no_overflow(memory);
      return cells_.keep(memory, cells_.at(bit), ValueSet(on, on)) && cells_.keep_sign(memory, bit, on) &&
             cells_.apply_sum(memory);
    }
    if (form.kind != Kind::Numbers || form.type == ContactForm::Type::Real) return true;
    const Width width = now.instruction->operand[0].width;
    const Relation relation = closed ? form.relation : opposite(form.relation);
    const ValueSet first = cells_.value_of(timed_, now[0], width, memory),
                   second = cells_.value_of(timed_, now[1], width, memory);
    if (first.empty() || second.empty()) return true;
    const ValueSet of_first = first.that_are(relation, second), of_second = second.that_are(mirrored(relation), first);
    if (of_first.empty() || of_second.empty()) return false;
    return cells_.keep(memory, cells_.of(now[0], width), of_first) &&
           cells_.keep(memory, cells_.of(now[1], width), of_second) && cells_.apply_sum(memory);
  }

  // --- what is written ---

  void write(std::uint32_t op, Way& way) const {
    const Op& now = timed_.ops[op];
    const auto box = value_box_of(*now.instruction);
    std::optional<ValueSet> result;
    if (box && !now[box->to].pointer) result = computed(op, *box, way.memory);
    const Effect effect = now.instruction->effect;
    if (effect == Effect::Coil) result = ValueSet(way.stack.top(), way.stack.top());
    if (effect == Effect::SetsBits || effect == Effect::ResetsBits)
      result = ValueSet(effect == Effect::SetsBits, effect == Effect::SetsBits);
    const bool of_bits = !box && result.has_value();
    std::optional<std::size_t> original;
    if (box && box->carries() && box->from)
      original = cells_.of(now[*box->from], now.instruction->operand[*box->from].width);
    const auto sum = sum_of(now, box, way.memory);
    if (way.memory.sum) way.memory.sum->shown_by_overflow = false;
    for (const MemoryAccess& access : facts_.effects[op]) {
      if (!access.writes() || is_anywhere(timed_, access)) continue;
      const bool by_name = is_of_operand(access) && !access.by_pointer && access.certainty == Certainty::Must;
      cells_.write(way.memory, access.bits, by_name ? result : std::nullopt, of_bits);
      if (by_name && original) cells_.make_copy(way.memory, *original, access.bits);
    }
    if (sum) way.memory.sum = sum;
  }

  /// What `+I VW2, AC0` after `MOVW VW0, AC0` makes.
  std::optional<WayMemory::Sum> sum_of(const Op& now, const std::optional<ValueBox>& box, const WayMemory& memory) const {
    if (!box || !box->from || now.instruction->mnemonic != "+I") return {};
    const auto total = cells_.of(now[box->to], Width::Word), added = cells_.of(now[*box->from], Width::Word);
    return total && added ? cells_.sum_of(memory, *total, *added) : std::nullopt;
  }

  ValueSet computed(std::uint32_t op, const ValueBox& box, const WayMemory& memory) const {
    const Op& now = timed_.ops[op];
    const Width width = now.instruction->operand[box.to].width;
    const ValueSet in = box.from ? cells_.value_of(timed_, now[*box.from], now.instruction->operand[*box.from].width, memory)
                                 : ValueSet(0, 0);
    return result_of(timed_, op, box, in, cells_.value_of(timed_, now[box.to], width, memory)).fitted(width);
  }

  // --- calls and loops ---

  void call(std::uint32_t op, const Way& way, Arrivals& arrivals, Through& through) {
    const std::uint32_t routine = facts_.flow.nodes[timed_.ops[op].target].routine;
    if (under_way_.contains(routine)) {
      through.loops.insert(op);
      return arrive(op + 1, {way.stack, cells_.nothing_known(), way.time}, arrivals);
    }
    const auto parts = has_patience() ? cells_.split(way.memory, routine) : std::vector{cells_.nothing_known()};
    for (const WayMemory& memory : parts) {
      const Through called = through_routine(routine, memory);
      through.include(called);
      if (called.ends) through.end_at(way.time + *called.ends);
      if (called.to_transmission) through.transmit_at(way.time + *called.to_transmission);
      for (const Way& exit : called.exits) {
        Way back{way.stack, exit.memory, way.time + exit.time};
        for (const MemoryAccess& access : facts_.effects[op])
          if (access.writes() && !is_anywhere(timed_, access)) cells_.write(back.memory, access.bits, {}, false);
        arrive(op + 1, std::move(back), arrivals);
      }
    }
  }

  /// The passes of a loop, the longest of all ways through its body; each has forgotten what they write.
  struct Pass {
    Time time = 0;
    Through through{};
    Arrivals leaves{};
  };
  Pass pass_of(std::uint32_t from, std::uint32_t to, const Way& way) {
    return new_pass(from, to, has_patience() ? way.memory : cells_.nothing_known());
  }
  Pass new_pass(std::uint32_t from, std::uint32_t to, WayMemory memory) {
    cells_.forget_dead(memory, from);
    for (const KnownPass& known : known_passes_)
      if (known.from == from && known.to == to && known.memory == memory) return known.pass;
    const Pass pass = followed_pass(from, to, memory);
    known_passes_.push_back({from, to, memory, pass});
    std::size_t ways = 1 + pass.through.exits.size();
    for (const auto& [op, leaving] : pass.leaves) ways += leaving.size();
    kept_ += ways * memory.value.size();
    return pass;
  }
  Pass followed_pass(std::uint32_t from, std::uint32_t to, const WayMemory& memory) {
    Pass pass;
    WayList all;
    for (unsigned top = 0; top < 2; ++top) {
      all.push_back({StackOfWay(top), memory, 0});
    }
    pass.leaves = walk(from, to, std::move(all), pass.through);
    for (const auto& [op, ways] : pass.leaves)
      for (const Way& each : ways) pass.time = std::max(pass.time, each.time);
    for (const Way& each : pass.through.exits) pass.time = std::max(pass.time, each.time);
    pass.time = std::max({pass.time, pass.through.ends.value_or(0), pass.through.to_transmission.value_or(0)});
    return pass;
  }

  std::int64_t passes(std::uint32_t op, std::optional<std::int64_t> on_this_way, Through& through) const {
    auto known = times_(op);
    if (!known || (on_this_way && *on_this_way < *known)) known = on_this_way;
    if (!known) through.loops.insert(op);
    if (known) through.count(op, *known);
    return known.value_or(1);
  }

  /// The ways that leave a body for somewhere else than the next pass, after `passes` at most.
  void leave(const Pass& pass, Time time, const Way& way, std::uint32_t but_for, Arrivals& arrivals,
             Through& through) const {
    for (const auto& [to, ways] : pass.leaves)
      if (to != but_for)
        for (const Way& each : ways) arrive(to, {each.stack, way.memory, time}, arrivals);
    for (const Way& exit : pass.through.exits) add_way(through.exits, {exit.stack, way.memory, time}, most_ways());
    through.include(pass.through);
    if (pass.through.ends) through.end_at(time);
    if (pass.through.to_transmission) through.transmit_at(time);
  }

  void run_loop(std::uint32_t op, Way way, Arrivals& arrivals, Through& through) {
    const Op& now = timed_.ops[op];
    const ValueSet first = cells_.value_of(timed_, now[1], Width::Word, way.memory),
                   last = cells_.value_of(timed_, now[2], Width::Word, way.memory);
    std::optional<std::int64_t> counted;
    const bool counts = counts_its_passes(facts_.flow, timed_, facts_.effects, op);
    if (counts && !first.empty() && !last.empty() && !last.is_all_of(Width::Word))
      counted = std::max<std::int64_t>(0, last.most() - first.least() + 1);
    forget_writes(op, now.target, way.memory);
    const Pass pass = pass_of(op + 1, now.target, way);
    const Time time = way.time + passes(op, counted, through) * pass.time;
    leave(pass, time, way, now.target, arrivals, through);
    way.time = time;
    arrive(now.target, std::move(way), arrivals);
  }

  /// A JMP back has the passes after the first one.
  void jump(std::uint32_t op, Way way, std::uint32_t from, Arrivals& arrivals, Through& through) {
    const Op& now = timed_.ops[op];
    if (now.target > op) return arrive(now.target, std::move(way), arrivals);
    if (now.target < from) {
      through.loops.insert(op);
      return arrive(op + 1, std::move(way), arrivals);
    }
    std::optional<std::int64_t> counted = passes_to_zero(op, way.memory);
    if (!counted) counted = passes_to_limit(op, way.memory);
    forget_writes(now.target, op, way.memory);
    const Pass pass = pass_of(now.target, op, way);
    const std::int64_t more = std::max<std::int64_t>(0, passes(op, counted, through) - 1);
    const Time time = way.time + more * (pass.time + now.cost);
    leave(pass, time, way, op, arrivals, through);
    way.time = time;
    arrive(op + 1, std::move(way), arrivals);
  }

  /// The passes of a loop that counts a cell down to 0: DEC of it stands in front of LDN SM1.0 and the JMP back, and nothing
  /// else in the loop writes it.
  std::optional<std::int64_t> passes_to_zero(std::uint32_t jump, const WayMemory& memory) const {
    const std::uint32_t target = timed_.ops[jump].target;
    if (jump < target + 2) return {};
    const Op &zero = timed_.ops[jump - 1], &counts = timed_.ops[jump - 2];
    const ContactForm form = contact_form(*zero.instruction);
    const bool until_zero = form.kind == ContactForm::Kind::Bit && form.inverted && form.join == Join::Load &&
                            !zero[0].pointer && zero[0].at == image::kSM + 1 && zero[0].bit == 0;
    if (!until_zero || step_of(timed_, counts) != -1 || !counts.instruction->mnemonic.starts_with("DEC")) return {};
    const auto cell = cells_.of(counts[0], counts.instruction->operand[0].width);
    if (!cell || !facts_.flow.nodes[jump - 2].powered || writes_within(target, jump - 2, *cell)) return {};
    const ValueSet& left = memory.value[*cell];
    if (left.empty() || left.least() < 0) return {};
    return left.most() + 1;
  }

  bool writes_within(std::uint32_t from, std::uint32_t to, std::size_t cell) const {
    for (std::uint32_t op = from; op < to; ++op)
      if (cells_.is_written(op, cell)) return true;
    return false;
  }

  /// The passes of a loop with a comparison in front of its JMP back, such as LDW>= VW0, 1: each adds the same constant to
  /// the number, and nothing leads around that.
  std::optional<std::int64_t> passes_to_limit(std::uint32_t jump, const WayMemory& memory) const {
    const std::uint32_t target = timed_.ops[jump].target;
    if (jump < target + 2) return {};
    const Op& compares = timed_.ops[jump - 1];
    const ContactForm form = contact_form(*compares.instruction);
    if (form.kind != ContactForm::Kind::Numbers || form.type == ContactForm::Type::Real || form.join != Join::Load)
      return {};
    const Width width = compares.instruction->operand[0].width;
    for (const std::size_t i : {0U, 1U}) {
      const auto cell = cells_.of(compares[i], width), other = cells_.of(compares[1 - i], width);
      const auto step = cell ? step_of_pass(target, jump - 1, *cell) : std::nullopt;
      if (!step || (other && writes_within(target, jump, *other))) continue;
      if (!other && !constant_value(timed_, compares[1 - i], width)) continue;
      return passes_until(i == 0 ? form.relation : mirrored(form.relation), *step, memory.value[*cell],
                          cells_.value_of(timed_, compares[1 - i], width, memory), range_of(width));
    }
    return {};
  }

  /// What each pass surely adds to a cell.
  std::optional<std::int64_t> step_of_pass(std::uint32_t from, std::uint32_t to, std::size_t cell) const {
    std::optional<std::int64_t> step;
    for (std::uint32_t op = from; op < to; ++op) {
      const Op& now = timed_.ops[op];
      const Structure role = flow_role(now);
      const bool straight =
          role == Structure::None || role == Structure::Compare || (role == Structure::Label && op == from);
      if (!straight || now.instruction->effect == Effect::ConditionalEnd) return {};
      if (!cells_.is_written(op, cell)) continue;
      const auto box = value_box_of(*now.instruction);
      if (step || !box || !facts_.flow.nodes[op].powered) return {};
      if (cells_.of(now[box->to], now.instruction->operand[box->to].width) != cell) return {};
      step = step_of(timed_, now);
      if (!step) return {};
    }
    return step;
  }

  /// The passes, the first too, of a loop that jumps back while a number has the relation with a limit. The number is what
  /// it is at the first jump, and does not overflow.
  static std::optional<std::int64_t> passes_until(Relation relation, std::int64_t step, const ValueSet& number,
                                                  const ValueSet& limit, const ValueRange& range) {
    if (number.empty() || limit.empty() || step == 0) return {};
    const bool up = step > 0;
    std::int64_t last = up ? limit.most() : limit.least();  // with which it still jumps
    switch (relation) {
      case Relation::Equal:
        return {};
      case Relation::NotEqual:
        if (std::abs(step) != 1 || (up ? number.most() >= limit.least() : number.least() <= limit.most())) return {};
        last -= step;
        break;
      case Relation::Less:
      case Relation::Greater:
        last -= up ? 1 : -1;
        [[fallthrough]];
      default:
        if (up != (relation == Relation::Less || relation == Relation::LessEqual)) return {};
    }
    if (last + step < range.least || last + step > range.most) return {};
    const std::int64_t left = up ? last - number.least() : number.most() - last;
    return left < 0 ? 1 : left / std::abs(step) + 2;
  }

  void forget_writes(std::uint32_t from, std::uint32_t to, WayMemory& memory) const {
    if (memory.sum) memory.sum->shown_by_overflow = false;
    for (std::uint32_t op = from; op < to; ++op) {
      for (const MemoryAccess& access : facts_.effects[op])
        if (access.writes() && !is_anywhere(timed_, access)) cells_.write(memory, access.bits, {}, false);
      if (flow_role(timed_.ops[op]) == Structure::Call)
        cells_.forget_writes_of(facts_.flow.nodes[timed_.ops[op].target].routine, memory);
    }
  }

  const Facts& facts_;
  const Program& timed_;
  const Times& times_;
  const Waiter& waiter_;
  const Assumed& assumed_;
  WayCells cells_;
  StackNeeds needs_;
  struct KnownPass {
    std::uint32_t from = 0, to = 0;
    WayMemory memory{};
    Pass pass{};
  };

  std::vector<Entry> known_{};
  std::vector<KnownPass> known_passes_{};
  std::set<std::uint32_t> under_way_{};  // routines
  std::uint64_t steps_ = 0, kept_ = 0;
};

std::vector<LongestWay> LongestWays::of_routines(const std::vector<std::uint32_t>& routines, const Assumed& assumed) const {
  Follower follower(*this, assumed);
  std::vector<LongestWay> ways;
  for (const std::uint32_t routine : routines) ways.push_back(follower.of_routine(routine));
  return ways;
}

LongestWay LongestWays::of_stretch(std::uint32_t from, std::uint32_t to, const Assumed& assumed) const {
  return Follower(*this, assumed).of_stretch(from, to);
}

}  // namespace s7200
