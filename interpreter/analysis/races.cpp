#include "interpreter/analysis/races.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <utility>

#include "interpreter/analysis/cross_reference.hpp"
#include "interpreter/analysis/effects/memory_names.hpp"
#include "interpreter/analysis/effects/value_boxes.hpp"
#include "interpreter/analysis/flow/first_scan.hpp"
#include "interpreter/analysis/flow/kept_away.hpp"
#include "interpreter/analysis/shared_memory.hpp"
#include "interpreter/program/loading/unread.hpp"

namespace s7200 {
namespace {

constexpr std::uint64_t kBitsOfByte = 8, kBitsOfWord = 16, kBitsOfDouble = 32;
constexpr std::size_t kFarthest = 300;                          ///< steps between a read and a write that depends on it
constexpr std::uint64_t kMostBits = kBitsOfByte * 255;          ///< of a block of which memory says how long it is, in bits
constexpr std::uint64_t kBitsOfFrame = std::uint64_t{1} << 40;  ///< more than the image has

bool is_shared(const Bits& bits) {
  return bits.first < kBitsOfFrame && contains(kSharedAreas, area_of(as_named(bits)));
}

Bits overlap_of(const Bits& a, const Bits& b) {
  const std::uint64_t first = std::max(a.first, b.first), end = std::min(a.end(), b.end());
  return {first, end > first ? end - first : 0};
}

/// An access of an op, as exactly as the program says.
struct Access {
  Bits bits;
  Role role = Role::In;
  bool certain = false;    ///< each execution with power flow accesses all of it
  bool somewhere = false;  ///< it is of some part of the bits: a pointer, a table or a string says of which
  bool anywhere = false;   ///< in an area
  bool of_operand = false;
  std::uint32_t pointer = 0;  ///< in the image, that leads to it; 0: none

  bool reads() const { return role != Role::Out; }
  bool writes() const { return role != Role::In; }
};

class Accesses {
 public:
  explicit Accesses(const Facts& facts) : facts_(facts) {
    for (std::uint32_t op = 0; op < facts.effects.size(); ++op) {
      all_.emplace_back();
      for (const MemoryAccess& access : facts.effects[op]) add(op, access);
    }
  }

  const std::vector<Access>& of(std::uint32_t op) const { return all_[op]; }

  Access access_of(std::uint32_t op, const MemoryAccess& access) const {
    Access result{access.bits, access.role, access.certainty == Certainty::Must};
    result.of_operand = access.operand != kNoOperand;
    result.anywhere = is_anywhere(facts_.program, access);
    if (!access.by_pointer || access.operand == kNoOperand) return result;
    result.pointer = facts_.program.ops[op][access.operand].at;
    const auto places = facts_.pointers.targets(op, result.pointer);
    result.somewhere = places.size() != 1 || places.front().to != places.front().from + 1;
    result.certain = !result.somewhere;
    return result;
  }

 private:
  void add(std::uint32_t op, const MemoryAccess& access) {
    const Instruction& instruction = *facts_.program.ops[op].instruction;
    const bool is_operand = access.operand != kNoOperand;
    const OperandRule rule = is_operand ? instruction.operand[access.operand] : OperandRule{};
    Access added = access_of(op, access);
    if (rule.most != 0 && !rule.text) {
      const bool table = rule.width == Width::Word && rule.role == Role::InOut && access.certainty == Certainty::Must;
      if (table) add_table(added);
      return;  // messages belong to the port
    }
    added.somewhere |= rule.text && access.certainty == Certainty::May;
    if (added.somewhere || added.certain || added.bits.count <= kMostBits) all_[op].push_back(added);
  }

  /// ATT, FIFO and LIFO count what is in their table, in its second word.
  void add_table(Access access) {
    access.bits = {access.bits.first + kBitsOfWord, kBitsOfWord};
    all_.back().push_back(access);
  }

  const Facts& facts_;
  std::vector<std::vector<Access>> all_{};
};

/// An op of a routine in the order of the text, with subroutines where they are called, or what a CALL or a RET does to a
/// parameter.
struct PlacedOp {
  std::uint32_t op = 0;
  std::uint32_t call = 0;  ///< which execution of a routine it belongs to; 0: that which begins
  std::span<const Access> accesses{};
};

/// An execution of a routine, and the CALL of another one that begins it. The first has none.
struct PlacedCall {
  std::uint32_t caller = 0, op = 0;
};

/// The steps of a routine and of what it calls.
struct Unfolded {
  std::vector<PlacedOp> steps;
  std::vector<PlacedCall> calls;
  std::vector<NotFollowed> not_followed;
  /// Accesses that are not everywhere the same, and those of parameters: by op, depth, and number of the parameter.
  std::map<std::tuple<std::uint32_t, std::size_t, std::size_t>, std::vector<Access>> of_depth;
};

class OpsInOrder {
 public:
  /// `most_depth`: how many calls the CPU nests there.
  OpsInOrder(const Facts& facts, const Accesses& accesses, const std::vector<bool>& left_out, std::size_t most_depth)
      : facts_(facts), accesses_(accesses), left_out_(left_out), most_depth_(most_depth) {
    for (const CallSite& site : facts.flow.calls) called_.emplace(site.op, site.routine);
  }

  Unfolded of(std::uint32_t routine) {
    from_ = routine;
    expand(routine, 0, {});
    return std::move(all_);
  }

 private:
  static constexpr std::size_t kOwn = 0, kHandedOver = 1, kHandedBack = 2;  // and further in steps of 2

  void expand(std::uint32_t routine, std::size_t depth, const PlacedCall& by) {
    const auto call = static_cast<std::uint32_t>(all_.calls.size());
    all_.calls.push_back(by);
    const Routine& what = facts_.flow.routines[routine];
    for (std::uint32_t op = what.first; op < what.end; ++op) {
      const Op& now = facts_.program.ops[op];
      if (now.instruction->structure == Structure::Call)
        expand_call(op, call, depth);
      else
        all_.steps.push_back({op, call, returns(now) ? std::span<const Access>() : accesses_at(op, depth)});
    }
  }

  bool returns(const Op& op) const {
    return op.instruction->structure == Structure::SubroutineEnd || op.instruction->effect == Effect::ConditionalEnd;
  }

  void expand_call(std::uint32_t op, std::uint32_t call, std::size_t depth) {
    const Op& now = facts_.program.ops[op];
    all_.steps.push_back({op, call});
    const auto site = called_.find(op);
    if (site == called_.end() || left_out_[op]) return;
    const std::uint32_t routine = site->second;
    if (depth == most_depth_) return leave(op, routine, NotFollowed::Reason::DeeperThanTheCpuCalls);
    if (all_.steps.size() > kMostStepsOfRaces) return leave(op, routine, NotFollowed::Reason::TooManySteps);
    const auto parameters = std::span(facts_.program.parameters).subspan(now[1].at, now[2].at);
    for (std::size_t i = 0; i < parameters.size(); ++i)
      if (parameters[i].role != Role::Out)
        move(op, {op, depth, kHandedOver + 2 * i}, call,
             [&] { return joined(actual(op, parameters[i], Role::In, depth), {local(parameters[i], Role::Out, depth)}); });
    expand(routine, depth + 1, {call, op});
    const std::uint32_t ret = facts_.flow.routines[routine].end - 1;
    for (std::size_t i = 0; i < parameters.size(); ++i)
      if (parameters[i].role != Role::In)
        move(ret, {op, depth, kHandedBack + 2 * i}, call,
             [&] { return joined({local(parameters[i], Role::In, depth)}, actual(op, parameters[i], Role::Out, depth)); });
  }

  void leave(std::uint32_t op, std::uint32_t routine, NotFollowed::Reason reason) {
    const NotFollowed left{reason, op, routine, from_};
    if (std::ranges::find(all_.not_followed, left) == all_.not_followed.end()) all_.not_followed.push_back(left);
  }

  template <class Accesses>
  void move(std::uint32_t op, const std::tuple<std::uint32_t, std::size_t, std::size_t>& key, std::uint32_t call,
            const Accesses& accesses) {
    const auto [known, is_new] = all_.of_depth.try_emplace(key);
    if (is_new) known->second = accesses();
    all_.steps.push_back({op, call, known->second});
  }
  static std::vector<Access> joined(std::vector<Access> from, const std::vector<Access>& to) {
    from.insert(from.end(), to.begin(), to.end());
    return from;
  }

  static Bits bits_of(const Operand& operand, Width width) {
    const std::uint64_t bits = width == Width::Bit ? 1 : kBitsOfByte * bytes_of(width);
    return {operand.at * kBitsOfByte + (width == Width::Bit ? operand.bit : 0u), bits};
  }
  Access local(const Parameter& parameter, Role role, std::size_t depth) const {
    return {at_depth(bits_of(parameter.local, parameter.width), depth + 1), role, true, false, false, true};
  }
  /// Of a pointer: each place that it may lead to.
  std::vector<Access> actual(std::uint32_t call, const Parameter& parameter, Role role, std::size_t depth) const {
    const Operand& operand = parameter.actual;
    if (operand.unread() || operand.at >= image::kConstants) return {};
    if (!operand.pointer) return {{at_depth(bits_of(operand, parameter.width), depth), role, true, false, false, true}};
    const auto places = facts_.pointers.targets(call, operand.at);
    std::vector<Access> all;
    for (const PointerTarget& place : places) {
      const Bits bits{place.from * kBitsOfByte, (place.to - 1 - place.from + bytes_of(parameter.width)) * kBitsOfByte};
      const bool somewhere = places.size() != 1 || place.to != place.from + 1;
      const bool anywhere = is_anywhere(facts_.program, {bits, role, Certainty::May, kNoOperand, true});
      all.push_back({bits, role, !somewhere, somewhere, anywhere, true, operand.at});
    }
    return all;
  }

  /// Each routine has local memory of its own.
  static bool is_local(const Bits& bits) {
    const Bits local{image::kL * kBitsOfByte, (image::kConstants - image::kL) * kBitsOfByte};
    return local.overlaps(bits) && local.contains(bits);
  }
  static Bits at_depth(const Bits& bits, std::size_t depth) {
    return is_local(bits) ? Bits{bits.first + depth * kBitsOfFrame, bits.count} : bits;
  }
  std::span<const Access> accesses_at(std::uint32_t op, std::size_t depth) {
    const std::vector<Access>& own = accesses_.of(op);
    if (depth == 0 || std::ranges::none_of(own, is_local, &Access::bits)) return own;
    const auto [known, is_new] = all_.of_depth.try_emplace({op, depth, kOwn}, own);
    for (Access& access : known->second)
      if (is_new) access.bits = at_depth(access.bits, depth);
    return known->second;
  }

  const Facts& facts_;
  const Accesses& accesses_;
  const std::vector<bool>& left_out_;
  std::size_t most_depth_;
  std::map<std::uint32_t, std::uint32_t> called_{};  // by CALL: its routine
  std::uint32_t from_ = 0;
  Unfolded all_{};
};

/// Tells during which steps DISI or DTCH surely keeps interrupts away.
class Protection {
 public:
  Protection(const Facts& facts, const Calls& calls, const std::vector<bool>& left_out, const Unfolded& main)
      : facts_(facts), calls_(calls), left_out_(left_out), main_(main) {}

  /// Whether no interrupt of an event comes between two steps.
  bool covers(std::size_t first, std::size_t last, std::uint8_t event) {
    return is_closed(of_all(), first, last) || (!is_attached_by_others(event) && is_closed(of_event(event), first, last));
  }

 private:
  /// With the executions of the steps, by their number, and the steps that let interrupts come.
  struct Barrier {
    KeptAway kept_away;
    std::vector<Execution> executions;
    std::vector<std::size_t> openings;
  };

  Barrier& of_all() {
    if (!of_all_) of_all_.emplace(barrier(gate_of_all_interrupts()));
    return *of_all_;
  }

  Barrier& of_event(std::uint8_t event) {
    const auto attaches = [event](const Op& op) {
      return op.instruction->structure == Structure::Attach && (op[1].unread() || op[1].at == event);
    };
    const auto detaches = [event](const Op& op) { return op.instruction->mnemonic == "DTCH" && op[0].at == event; };
    const auto known = of_event_.find(event);
    return known != of_event_.end() ? known->second : of_event_.emplace(event, barrier({attaches, detaches})).first->second;
  }

  Barrier barrier(const InterruptGate& gate) const {
    Barrier made{KeptAway(facts_.program, facts_.flow, left_out_, gate), {Execution{}}, {}};
    for (std::size_t i = 1; i < main_.calls.size(); ++i)
      made.executions.push_back(made.kept_away.called(made.executions[main_.calls[i].caller], main_.calls[i].op));
    for (std::size_t step = 0; step < main_.steps.size(); ++step)
      if (gate.opens(facts_.program.ops[main_.steps[step].op])) made.openings.push_back(step);
    return made;
  }

  /// Whether an interrupt of another event, which comes after a DTCH too, attaches this one again.
  bool is_attached_by_others(std::uint8_t event) const {
    return std::ranges::any_of(facts_.flow.attachments, [&](const Attachment& attachment) {
      std::set<std::uint32_t> seen;
      return attachment.event.value_or(event) == event &&
             is_started_by_others(facts_.flow.nodes[attachment.op].routine, event, seen);
    });
  }
  bool is_started_by_others(std::uint32_t routine, std::uint8_t event, std::set<std::uint32_t>& seen) const {
    if (!seen.insert(routine).second) return false;
    const Calls::Node& node = calls_.nodes[routine];
    return std::ranges::any_of(node.events, [event](std::uint8_t each) { return each != event; }) ||
           std::ranges::any_of(node.called,
                               [&](const CallSite& site) { return is_started_by_others(site.routine, event, seen); });
  }

  bool is_closed(Barrier& barrier, std::size_t first, std::size_t last) const {
    const auto opening = std::ranges::lower_bound(barrier.openings, first);
    if (opening != barrier.openings.end() && *opening < last) return false;
    const PlacedOp& step = main_.steps[first];
    const Execution& execution = barrier.executions[step.call];
    if (facts_.flow.nodes[step.op].routine == execution.routine) return barrier.kept_away.in_front(execution, step.op);
    std::size_t inner = first;  // it hands a parameter back: its op is the RET
    while (main_.steps[inner].call == step.call) --inner;
    return barrier.kept_away.behind(barrier.executions[main_.steps[inner].call]);
  }

  const Facts& facts_;
  const Calls& calls_;
  const std::vector<bool>& left_out_;
  const Unfolded& main_;
  std::optional<Barrier> of_all_{};
  std::map<std::uint8_t, Barrier> of_event_{};
};

class RaceFinder {
 public:
  RaceFinder(const Facts& facts, const Calls& calls, const Waiter& waiter)
      : facts_(facts),
        calls_(calls),
        waiter_(waiter),
        accesses_(facts),
        first_scan_(ops_of_first_scan(facts.program)),
        protection_(facts, calls, first_scan_, main_) {}

  Races all() {
    if (calls_.enabling.empty()) return {};
    main_ = OpsInOrder(facts_, accesses_, first_scan_, facts_.program.model->call_depth).of(0);
    not_followed_ = main_.not_followed;
    for (std::size_t step = 0; step < main_.steps.size(); ++step) steps_of_call_[main_.steps[step].call].push_back(step);
    for (std::uint32_t i = 0; i < calls_.nodes.size(); ++i)
      if (!calls_.nodes[i].events.empty()) with_interrupt(i);
    std::ranges::sort(races_, {}, [](const Race& race) { return std::tuple(race.first, race.last, race.interrupt); });
    return {std::move(races_), std::move(not_followed_)};
  }

 private:
  /// An access of an interrupt routine.
  struct Foreign {
    std::uint32_t op = 0;
    Access access;
    std::size_t run = 0;  ///< those with the same number are executed together
  };

  void with_interrupt(std::uint32_t routine) {
    interrupt_ = routine;
    foreign_.clear();
    counting_.clear();
    std::set<std::tuple<std::uint32_t, std::uint64_t, std::uint64_t, Role>> known;  // a routine may be called often
    const std::vector<bool> nothing(facts_.program.ops.size());
    const Unfolded all = OpsInOrder(facts_, accesses_, nothing, facts_.program.model->interrupt_call_depth).of(routine);
    not_followed_.insert(not_followed_.end(), all.not_followed.begin(), all.not_followed.end());
    std::size_t run = 0;
    for (const PlacedOp& step : all.steps) {
      run += begins_run(step.op);
      for (const Access& access : step.accesses)
        if (access.bits.count != 0 && !access.anywhere && is_shared(access.bits) &&
            known.emplace(step.op, access.bits.first, access.bits.count, access.role).second)
          foreign_.push_back({step.op, access, run});
    }
    if (foreign_.empty()) return;
    for (std::size_t step = 0; step < main_.steps.size() && !waiter_.asks_to_end(); ++step) {
      if (is_unread(op(step))) continue;
      for (const Access& access : main_.steps[step].accesses) {
        if (access.bits.count == 0 || !is_shared(access.bits) || !writer_of(access.bits)) continue;
        if (counts(access)) counting_.emplace_back(step, &access);
        if (access.role == Role::In) follow(step, access);
        if (access.role == Role::In && !op(step).is_contact) find_mixed(step, access);
        if (access.role == Role::Out && !access.somewhere) keep(step, access);
      }
    }
    for (std::size_t step = 0; step < main_.steps.size() && !waiter_.asks_to_end(); ++step) {
      if (is_unread(op(step))) continue;
      if (op(step).instruction->structure == Structure::For) find_shared_index(step);
      if (op(step).instruction->structure == Structure::Jump) find_shared_count(step);
    }
    find_torn(Race::Kind::TornRead);
    find_torn(Race::Kind::TornWrite);
  }

  const Op& op(std::size_t step) const { return facts_.program.ops[main_.steps[step].op]; }

  /// Whether a box or a coil has power flow in the first scan only.
  bool is_of_first_scan(std::size_t step) const { return !op(step).is_contact && first_scan_[main_.steps[step].op]; }

  struct Pair {
    std::size_t first = 0, last = 0;
  };

  /// Whether an op of the interrupt may be executed without that in front of it, or that without it.
  bool begins_run(std::uint32_t number) const {
    const Op& now = facts_.program.ops[number];
    const auto& nodes = facts_.flow.nodes;
    const bool is_always_on = now.is_contact && nodes[number].powered && number + 1 < nodes.size() && nodes[number + 1].powered;
    return (now.is_contact && !is_always_on) || is_unread(now) || now.instruction->structure != Structure::None ||
           now.instruction->effect == Effect::ConditionalEnd;
  }

  void add(Race::Kind kind, const Bits& bits, const Pair& steps, const Foreign& foreign, bool suspected) {
    const std::uint32_t first = main_.steps[steps.first].op, last = main_.steps[steps.last].op;
    if (is_of_first_scan(steps.first) || is_of_first_scan(steps.last)) return;
    const auto known = std::ranges::find_if(races_, [&](const Race& race) {
      return race.routine == interrupt_ && race.last == last && race.kind == kind && race.bits == as_named(bits);
    });
    if (known != races_.end() && (suspected || !known->suspected)) return;
    const auto& events = calls_.nodes[interrupt_].events;
    const auto event =
        std::ranges::find_if(events, [&](std::uint8_t each) { return !protection_.covers(steps.first, steps.last, each); });
    if (event == events.end()) return;
    if (known == races_.end())
      races_.push_back({kind, as_named(bits), first, last, foreign.op, interrupt_, *event, suspected});
    else
      *known = {kind, as_named(bits), first, last, foreign.op, interrupt_, *event, suspected};
  }

  /// What the interrupt writes of some bits; where that is certain, if there is any of it.
  const Foreign* writer_of(const Bits& bits) const {
    const Foreign* found = nullptr;
    for (const Foreign& each : foreign_) {
      if (!each.access.writes() || !each.access.bits.overlaps(bits)) continue;
      if (!each.access.somewhere) return &each;
      if (!found) found = &each;
    }
    return found;
  }

  // --- what is written after a read ---

  static bool overlaps_any(const std::vector<Bits>& all, const Bits& bits) {
    return std::ranges::any_of(all, [&](const Bits& each) { return each.overlaps(bits); });
  }

  /// Whether a contact begins what the rung depends on, and nothing in front of it matters to it any more.
  bool begins_rung(std::size_t step, int pushed) const {
    const Op& now = op(step);
    return now.is_contact && now.instruction->rung.stack.needs == 0 && now.instruction->rung.stack.change > 0 &&
           pushed == 0 && (step == 0 || !op(step - 1).is_contact);
  }

  /// Follows what depends on a read of shared memory, until the program writes that memory or nothing depends on it any
  /// more.
  void follow(std::size_t reader, const Access& read) {
    const Op& first = op(reader);
    bool decides = first.is_contact;  // whether the power flow of the rung depends on it
    bool only_decides = decides;      // and nothing is worked out from its value
    std::vector<Bits> dependent;
    if (!decides) note_writes(reader, dependent);
    bool kept = std::ranges::any_of(dependent, [](const Bits& bits) { return area_of(as_named(bits)) != Area::AC; });
    int pushed = 0;  // LPS without their LPP
    const std::size_t end = std::min(main_.steps.size(), reader + kFarthest);
    for (std::size_t step = reader + 1; step < end; ++step) {
      const Op& now = op(step);
      if (is_unread(now)) return;
      if (now.instruction->mnemonic == "LPS") ++pushed;
      if (now.instruction->mnemonic == "LPP") pushed = std::max(0, pushed - 1);
      if (now.is_contact && reads_any(step, dependent))
        decides = true;
      else if (begins_rung(step, pushed))
        decides = false;
      if (now.is_contact) continue;
      const bool uses = reads_any(step, dependent), depends = decides || uses;
      only_decides &= !uses;
      kept |= uses;
      if (const Access* write = write_back(step, read)) {
        const bool by_coil = now.instruction->effect == Effect::Coil;
        if (depends) return found(Race::Kind::LostUpdate, read, *write, {reader, step}, only_decides && !by_coil);
        if (kept && belong_together(reader, step)) return found(Race::Kind::Overwritten, read, *write, {reader, step}, true);
      }
      if (rereads(step, read.bits)) return;  // the later read is the one that counts
      if (!depends) forget_overwritten(step, dependent);
      if (depends) note_writes(step, dependent);
      if (!decides && dependent.empty() && !kept) return;
    }
  }

  bool reads_any(std::size_t step, const std::vector<Bits>& dependent) const {
    return std::ranges::any_of(main_.steps[step].accesses, [&](const Access& access) {
      return access.reads() && access.bits.count != 0 && overlaps_any(dependent, access.bits);
    });
  }

  /// Whether a box reads it again for what follows. One that reads and writes it in one instruction is no read of it.
  bool rereads(std::size_t step, const Bits& shared) const {
    return std::ranges::any_of(main_.steps[step].accesses, [&](const Access& access) {
      return access.role == Role::In && access.of_operand && access.bits == shared;
    });
  }

  /// What a step writes of memory that was read. Of bits that are set or reset nothing depends on their old value.
  const Access* write_back(std::size_t step, const Access& read) const {
    for (const Access& access : main_.steps[step].accesses) {
      const Bits both = overlap_of(access.bits, read.bits);
      if (access.role != Role::Out || both.count == 0) continue;
      if (both.count < kBitsOfByte && (read.bits.count != 1 || op(step).instruction->effect != Effect::Coil)) continue;
      if (writer_of(both)) return &access;
    }
    return nullptr;
  }

  /// If a pointer says where it is, each word that the interrupt writes may be meant.
  void found(Race::Kind kind, const Access& read, const Access& write, const Pair& steps, bool suspected) {
    const Bits both = overlap_of(write.bits, read.bits);
    if (!read.somewhere && !write.somewhere && both.count <= kBitsOfDouble) {
      const Foreign& writer = *writer_of(both);
      return add(kind, both, steps, writer, suspected || writer.access.somewhere);
    }
    const bool sure = read.certain && write.certain;
    for (const Foreign& each : foreign_)
      if (each.access.writes() && each.access.bits.overlaps(both))
        add(kind, overlap_of(both, each.access.bits), steps, each, suspected || !sure || each.access.somewhere);
  }

  /// Whether what is written after a read is meant for what was read: in the same network, under the same condition, or
  /// always.
  bool belong_together(std::size_t reader, std::size_t writer) const {
    const auto& nodes = facts_.flow.nodes;
    const std::uint32_t first = main_.steps[reader].op, last = main_.steps[writer].op;
    if (nodes[last].powered || (nodes[first].network == nodes[last].network)) return true;
    return condition_of(reader) == condition_of(writer);
  }

  /// The contacts in front of a step in its rung, as numbers of what they are.
  std::vector<std::tuple<const Instruction*, std::uint32_t, std::uint8_t, std::uint32_t>> condition_of(
      std::size_t step) const {
    std::vector<std::tuple<const Instruction*, std::uint32_t, std::uint8_t, std::uint32_t>> contacts;
    while (step > 0 && !op(step).is_contact) --step;
    for (; op(step).is_contact; --step) {
      const Op& now = op(step);
      contacts.emplace_back(now.instruction, now[0].at, now[0].bit, now[1].at);
      if (step == 0) break;
    }
    return contacts;
  }

  void note_writes(std::size_t step, std::vector<Bits>& dependent) const {
    for (const Access& access : main_.steps[step].accesses)
      if (access.writes() && access.of_operand && access.bits.count != 0 && !overlaps_whole(dependent, access.bits))
        dependent.push_back(access.bits);
  }
  static bool overlaps_whole(const std::vector<Bits>& all, const Bits& bits) {
    return std::ranges::any_of(all, [&](const Bits& each) { return each.contains(bits); });
  }

  /// MOVW writes one half of an accumulator: the other one stays.
  void forget_overwritten(std::size_t step, std::vector<Bits>& dependent) const {
    for (const Access& access : main_.steps[step].accesses) {
      if (access.role != Role::Out || !access.certain || access.bits.count == 0) continue;
      std::vector<Bits> left;
      for (const Bits& bits : dependent) {
        const Bits both = overlap_of(bits, access.bits);
        if (both.count == 0) left.push_back(bits);
        if (both.count == 0) continue;
        if (both.first > bits.first) left.push_back({bits.first, both.first - bits.first});
        if (both.end() < bits.end()) left.push_back({both.end(), bits.end() - both.end()});
      }
      dependent = std::move(left);
    }
  }

  // --- what is read after a write ---

  /// Memory that the main program always writes before it reads it, and the interrupt writes as well: both keep something
  /// in it for a while.
  void keep(std::size_t writer, const Access& write) {
    if (write.bits.count < kBitsOfByte || !write.of_operand) return;
    const auto foreign = std::ranges::find_if(foreign_, [&](const Foreign& each) {
      return each.access.role == Role::Out && each.access.of_operand && each.access.bits.overlaps(write.bits);
    });
    if (foreign == foreign_.end()) return;
    const bool constant = writes_constant(writer);
    const std::size_t end = std::min(main_.steps.size(), writer + kFarthest);
    std::optional<std::size_t> changed;
    for (std::size_t step = writer + 1; step < end; ++step) {
      if (is_unread(op(step))) return;
      for (const Access& access : main_.steps[step].accesses) {
        if (access.bits.count == 0 || !access.bits.overlaps(write.bits)) continue;
        if (access.role == Role::Out && access.certain) return;
        if (access.role == Role::InOut) changed = changed.value_or(step);
        if (access.role != Role::In || op(step).is_contact) continue;
        const bool as_pointer = leads(step, write.bits);
        if (constant && !as_pointer && !changed) return;
        if (!is_read_first(write.bits)) add(Race::Kind::Scratch, write.bits, {writer, step}, *foreign, true);
        return;
      }
    }
  }

  /// FOR writes its index, and each NEXT counts it and compares: it belongs to the loop from the first pass to the last.
  void find_shared_index(std::size_t begin) {
    const auto index = std::ranges::find_if(main_.steps[begin].accesses, [](const Access& access) {
      return access.role == Role::Out && access.of_operand && !access.somewhere && is_shared(access.bits);
    });
    const Foreign* const writer = index == main_.steps[begin].accesses.end() ? nullptr : writer_of(index->bits);
    if (!writer) return;
    for (std::size_t step = begin + 1; step < main_.steps.size(); ++step) {
      const bool ends = op(step).instruction->structure == Structure::Next && op(step).target == main_.steps[begin].op + 1;
      if (!ends || main_.steps[step].call != main_.steps[begin].call) continue;
      return add(Race::Kind::Scratch, index->bits, {begin, step}, *writer, writer->access.somewhere);
    }
  }

  /// A loop that is closed by a jump backwards, and counts what the program has written in front of it.
  void find_shared_count(std::size_t jump) {
    const std::uint32_t label = op(jump).target;
    if (label >= main_.steps[jump].op) return;
    const std::vector<std::size_t>& steps = steps_of_call_.at(main_.steps[jump].call);
    const auto begin = std::ranges::lower_bound(steps, label, {}, [&](std::size_t step) { return main_.steps[step].op; });
    if (main_.steps[*begin].op != label) return;
    auto count = std::ranges::lower_bound(counting_, *begin, {}, &Counting::first);
    for (; count != counting_.end() && count->first < jump; ++count)
      if (const auto written = written_in_front(*begin, count->second->bits))
        add(Race::Kind::Scratch, count->second->bits, {*written, jump}, *writer_of(count->second->bits), true);
  }

  /// Whether an instruction surely works on a value in its place.
  static bool counts(const Access& access) {
    return access.role == Role::InOut && access.certain && access.of_operand && access.bits.count >= kBitsOfByte;
  }

  /// The step, not far in front of another one of the same execution, that writes some memory.
  std::optional<std::size_t> written_in_front(std::size_t step, const Bits& bits) const {
    constexpr std::size_t kNear = 20;
    const std::uint32_t call = main_.steps[step].call;
    for (std::size_t before = step; before-- > 0 && before + kNear >= step;)
      for (const Access& access : main_.steps[before].accesses) {
        if (main_.steps[before].call != call || !access.bits.overlaps(bits) || !access.writes()) continue;
        return access.role == Role::Out && access.certain && access.bits == bits ? std::optional(before) : std::nullopt;
      }
    return {};
  }

  bool leads(std::size_t step, const Bits& pointer) const {
    return std::ranges::any_of(main_.steps[step].accesses, [&](const Access& access) {
      return access.pointer != 0 && access.pointer * kBitsOfByte == pointer.first;
    });
  }

  bool writes_constant(std::size_t step) const {
    const auto box = value_box_of(*op(step).instruction);
    return box && box->carries() && box->from && !op(step)[*box->from].pointer &&
           op(step)[*box->from].at >= image::kConstants;
  }

  /// Whether the main program reads some memory in front of all that it writes there.
  bool is_read_first(const Bits& bits) {
    const auto [answer, is_new] = read_first_.try_emplace({bits.first, bits.count}, false);
    for (std::size_t step = 0; is_new && step < main_.steps.size(); ++step)
      for (const Access& access : main_.steps[step].accesses) {
        if (!access.bits.overlaps(bits) || access.somewhere || is_of_first_scan(step)) continue;
        return answer->second = access.reads();
      }
    return answer->second;
  }

  // --- words that belong together ---

  /// A second read of the main program, and what depends on it.
  struct SecondRead {
    std::size_t step = 0;
    Bits bits;
    const Foreign* writer = nullptr;
    std::vector<Bits> dependent;
  };

  /// Two words that the interrupt always writes together, from which the main program works out one value: between its two
  /// reads one of them becomes new.
  void find_mixed(std::size_t reader, const Access& read) {
    if (!is_value(read)) return;
    for (const Foreign& each : foreign_)
      if (writes_whole(each, read.bits)) return follow_mixed(reader, read, each);
  }

  static bool is_value(const Access& access) {
    return access.of_operand && access.certain && !access.somewhere && access.bits.count >= kBitsOfByte &&
           access.bits.count <= kBitsOfDouble;
  }
  static bool writes_whole(const Foreign& foreign, const Bits& bits) {
    return foreign.access.writes() && foreign.access.certain && !foreign.access.somewhere &&
           foreign.access.bits.contains(bits);
  }

  void follow_mixed(std::size_t reader, const Access& read, const Foreign& writer) {
    std::vector<Bits> dependent;
    std::vector<SecondRead> second;
    note_writes(reader, dependent);
    const std::size_t end = std::min(main_.steps.size(), reader + kFarthest);
    for (std::size_t step = reader + 1; step < end && !dependent.empty(); ++step) {
      if (is_unread(op(step)) || rereads(step, read.bits)) return;
      if (op(step).is_contact) continue;
      const bool uses = reads_any(step, dependent);
      if (auto other = second_read(reader, step, read, writer)) second.push_back(*other);
      for (SecondRead& other : second) {
        const bool combines = other.step == step || reads_any(step, other.dependent);
        if (uses && combines) return mixed(reader, read, other);
        hand_on(step, combines, other.dependent);
      }
      hand_on(step, uses, dependent);
    }
  }

  void hand_on(std::size_t step, bool depends, std::vector<Bits>& dependent) const {
    if (depends)
      note_writes(step, dependent);
    else
      forget_overwritten(step, dependent);
  }

  std::optional<SecondRead> second_read(std::size_t reader, std::size_t step, const Access& read,
                                        const Foreign& writer) const {
    for (const Access& access : main_.steps[step].accesses) {
      if (access.role != Role::In || !is_value(access) || access.bits.overlaps(read.bits)) continue;
      const auto other = std::ranges::find_if(foreign_, [&](const Foreign& each) {
        return each.run == writer.run && each.op != writer.op && writes_whole(each, access.bits);
      });
      if (other != foreign_.end() && belong_together(reader, step)) return SecondRead{step, access.bits, &*other, {}};
    }
    return {};
  }

  void mixed(std::size_t reader, const Access& read, const SecondRead& other) {
    const std::size_t count = races_.size();
    add(Race::Kind::MixedRead, read.bits, {reader, other.step}, *other.writer, true);
    if (races_.size() != count) races_.back().with = as_named(other.bits);
  }

  // --- parts ---

  /// Two steps of a routine, each of which accesses another part of what an op of the interrupt accesses as a whole.
  void find_torn(Race::Kind kind) {
    const bool reads = kind == Race::Kind::TornRead;
    for (const Foreign& foreign : foreign_) {
      if (waiter_.asks_to_end()) return;
      const Bits& whole = foreign.access.bits;
      const bool meant = reads ? foreign.access.writes() : foreign.access.reads();
      if (!meant || foreign.access.somewhere || whole.count < kBitsOfWord || whole.count > kBitsOfDouble) continue;
      std::map<std::uint32_t, std::pair<std::size_t, Bits>> earlier;  // by execution of a routine
      std::set<std::uint32_t> done;
      for (std::size_t step = 0; step < main_.steps.size(); ++step) {
        const auto part = part_of(step, whole, reads);
        const std::uint32_t call = main_.steps[step].call;
        if (!part || done.contains(call)) continue;
        const auto before = earlier.find(call);
        if (before != earlier.end() && !before->second.second.overlaps(*part)) {
          add(kind, whole, {before->second.first, step}, foreign, false);
          done.insert(call);
        }
        earlier[call] = {step, *part};
      }
    }
  }

  std::optional<Bits> part_of(std::size_t step, const Bits& whole, bool reads) const {
    if (is_of_first_scan(step)) return {};
    for (const Access& access : main_.steps[step].accesses) {
      const bool meant = reads ? access.role == Role::In : access.role == Role::Out;
      const Bits both = overlap_of(access.bits, whole);
      if (meant && access.of_operand && !access.somewhere && both.count >= kBitsOfByte && both.count < whole.count)
        return both;
    }
    return {};
  }

  const Facts& facts_;
  const Calls& calls_;
  const Waiter& waiter_;
  Accesses accesses_;
  std::vector<bool> first_scan_;
  Unfolded main_{};  // the main program
  Protection protection_;
  std::uint32_t interrupt_ = 0;
  std::vector<Foreign> foreign_{};
  using Counting = std::pair<std::size_t, const Access*>;
  std::vector<Counting> counting_{};                                      // steps that count what the interrupt writes
  std::map<std::uint32_t, std::vector<std::size_t>> steps_of_call_{};     // in the order of their ops
  std::map<std::pair<std::uint64_t, std::uint64_t>, bool> read_first_{};  // what is_read_first() has answered
  std::vector<Race> races_{};
  std::vector<NotFollowed> not_followed_{};
};

}  // namespace

Races find_races(const Facts& facts, const Calls& calls, const Waiter& waiter) {
  return RaceFinder(facts, calls, waiter).all();
}

}  // namespace s7200
