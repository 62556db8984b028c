#include "interpreter/analysis/races.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <tuple>
#include <utility>

#include "interpreter/analysis/cross_reference.hpp"
#include "interpreter/analysis/effects/memory_names.hpp"
#include "interpreter/analysis/effects/value_boxes.hpp"
#include "interpreter/analysis/flow/first_scan.hpp"
#include "interpreter/base/bytes.hpp"
#include "interpreter/program/loading/unread.hpp"

namespace s7200 {
namespace {

constexpr std::uint64_t kBitsOfByte = 8, kBitsOfWord = 16, kBitsOfDouble = 32;
constexpr std::size_t kFarthest = 300;                          ///< steps between a read and a write that depends on it
constexpr std::size_t kMostSteps = 60'000;                      ///< the most steps into which a program is unfolded
constexpr std::size_t kMostDepth = 8;                           ///< the deepest nesting of calls that is followed
constexpr std::uint64_t kMostBits = kBitsOfByte * 255;          ///< the longest block of an instruction, in bits
constexpr std::uint64_t kBitsOfFrame = std::uint64_t{1} << 40;  ///< more than the image has

bool is_shared(const Bits& bits) {
  constexpr Areas kShared =
      set_of(Area::V) | set_of(Area::M) | set_of(Area::S) | set_of(Area::Q) | set_of(Area::T) | set_of(Area::C);
  return bits.first < kBitsOfFrame && contains(kShared, area_of(as_named(bits)));
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
    if (added.somewhere || added.bits.count <= kMostBits) all_[op].push_back(added);
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
  std::vector<Access> accesses{};
};

/// The steps of a routine and of what it calls.
class OpsInOrder {
 public:
  OpsInOrder(const Facts& facts, const Calls& calls, const Accesses& accesses, const std::vector<bool>& left_out)
      : facts_(facts), calls_(calls), accesses_(accesses), left_out_(left_out) {}

  std::vector<PlacedOp> of(std::uint32_t routine) {
    steps_.clear();
    count_ = 0;
    expand(routine, 0);
    return std::move(steps_);
  }

 private:
  void expand(std::uint32_t routine, std::size_t depth) {
    const std::uint32_t call = count_++;
    const Routine& what = facts_.flow.routines[routine];
    for (std::uint32_t op = what.first; op < what.end; ++op) {
      const Op& now = facts_.program.ops[op];
      if (now.instruction->structure == Structure::Call)
        expand_call(op, call, depth);
      else
        add(op, call, depth, returns(now) ? std::vector<Access>{} : accesses_.of(op));
    }
  }

  bool returns(const Op& op) const {
    return op.instruction->structure == Structure::SubroutineEnd || op.instruction->effect == Effect::ConditionalEnd;
  }

  void expand_call(std::uint32_t op, std::uint32_t call, std::size_t depth) {
    const Op& now = facts_.program.ops[op];
    add(op, call, depth, {});
    const auto site = std::ranges::find(facts_.flow.calls, op, &CallSite::op);
    if (site == facts_.flow.calls.end() || left_out_[op] || depth + 1 > kMostDepth || steps_.size() > kMostSteps) return;
    if (!calls_.nodes[site->routine].depth) return;  // it calls itself
    const auto parameters = std::span(facts_.program.parameters).subspan(now[1].at, now[2].at);
    for (const Parameter& parameter : parameters)
      if (parameter.role != Role::Out)
        move(op, call, actual(op, parameter, Role::In, depth), {local(parameter, Role::Out, depth)});
    expand(site->routine, depth + 1);
    const std::uint32_t ret = facts_.flow.routines[site->routine].end - 1;
    for (const Parameter& parameter : parameters)
      if (parameter.role != Role::In)
        move(ret, call, {local(parameter, Role::In, depth)}, actual(op, parameter, Role::Out, depth));
  }

  void add(std::uint32_t op, std::uint32_t call, std::size_t depth, std::vector<Access> accesses) {
    for (Access& access : accesses) access.bits = at_depth(access.bits, depth);
    steps_.push_back({op, call, std::move(accesses)});
  }
  void move(std::uint32_t op, std::uint32_t call, std::vector<Access> from, const std::vector<Access>& to) {
    from.insert(from.end(), to.begin(), to.end());
    steps_.push_back({op, call, std::move(from)});
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
  static Bits at_depth(const Bits& bits, std::size_t depth) {
    const Bits local{image::kL * kBitsOfByte, (image::kConstants - image::kL) * kBitsOfByte};
    return local.overlaps(bits) && local.contains(bits) ? Bits{bits.first + depth * kBitsOfFrame, bits.count} : bits;
  }

  const Facts& facts_;
  const Calls& calls_;
  const Accesses& accesses_;
  const std::vector<bool>& left_out_;
  std::vector<PlacedOp> steps_{};
  std::uint32_t count_ = 0;
};

/// Tells during which steps DISI or DTCH surely keeps interrupts away.
class Protection {
 public:
  Protection(const Facts& facts, const Calls& calls, const std::vector<PlacedOp>& steps)
      : facts_(facts), calls_(calls), steps_(steps) {}

  /// Whether no interrupt of an event comes between two steps.
  bool covers(std::size_t first, std::size_t last, std::uint8_t event) const {
    const auto enables = [](const Op& op) { return op.instruction->effect == Effect::EnablesInterrupts; };
    const auto disables = [](const Op& op) { return op.instruction->mnemonic == "DISI"; };
    const auto attaches = [event](const Op& op) {
      return op.instruction->structure == Structure::Attach && (op[1].unread() || op[1].at == event);
    };
    const auto detaches = [event](const Op& op) { return op.instruction->mnemonic == "DTCH" && op[0].at == event; };
    return is_closed(first, last, enables, disables) ||
           (!is_attached_by_others(event) && is_closed(first, last, attaches, detaches));
  }

 private:
  const Op& op(std::size_t step) const { return facts_.program.ops[steps_[step].op]; }

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

  template <class Opens, class Closes>
  bool is_closed(std::size_t first, std::size_t last, const Opens& opens, const Closes& closes) const {
    for (std::size_t i = first; i < last; ++i)
      if (opens(op(i))) return false;
    for (std::size_t i = first; i-- > 0;) {
      if (opens(op(i))) return false;
      if (closes(op(i))) return is_executed_with(i, first);
    }
    return false;
  }

  /// Whether a step has power flow whenever a later one has.
  bool is_executed_with(std::size_t closing, std::size_t later) const {
    if (facts_.flow.nodes[steps_[closing].op].powered) return !leads_past(closing, later);
    for (std::size_t i = closing + 1; i < later; ++i) {
      if (!is_beside(i, closing)) continue;
      const Op& between = op(i);
      const std::string_view mnemonic = between.instruction->mnemonic;
      const bool only_takes_power = mnemonic.starts_with('A') && mnemonic != "ALD";
      if (between.is_contact && !only_takes_power) return false;
      const Structure structure = between.instruction->structure;
      if (structure != Structure::None && structure != Structure::Call && structure != Structure::Attach) return false;
    }
    return true;
  }

  /// Whether some way leads past the closing step: a label, to which a jump may come, a way out of its routine, or a CALL of
  /// that which is left out.
  bool leads_past(std::size_t closing, std::size_t later) const {
    bool left = false;
    for (std::size_t i = closing + 1; i <= later; ++i) {
      if (!is_beside(i, closing)) continue;
      const Structure structure = op(i).instruction->structure;
      if (structure == Structure::Label) return true;
      left |= structure == Structure::SubroutineEnd;
    }
    if (!left) return false;
    for (std::size_t i = closing; i-- > 0;)
      if (is_beside(i, closing) && op(i).instruction->effect == Effect::ConditionalEnd) return true;
    const auto head = std::ranges::find(steps_, steps_[closing].call, &PlacedOp::call) - steps_.begin();
    return head != 0 && !is_executed_with(static_cast<std::size_t>(head) - 1, later);
  }

  /// Whether a step is of the same execution of the same routine. What hands parameters back is not: its op is the RET.
  bool is_beside(std::size_t step, std::size_t closing) const {
    const auto& nodes = facts_.flow.nodes;
    return steps_[step].call == steps_[closing].call && nodes[steps_[step].op].routine == nodes[steps_[closing].op].routine;
  }

  const Facts& facts_;
  const Calls& calls_;
  const std::vector<PlacedOp>& steps_;
};

class RaceFinder {
 public:
  RaceFinder(const Facts& facts, const Calls& calls, const Waiter& waiter)
      : facts_(facts),
        calls_(calls),
        waiter_(waiter),
        accesses_(facts),
        first_scan_(ops_of_first_scan(facts.program)),
        protection_(facts, calls, steps_) {}

  std::vector<Race> all() {
    if (calls_.enabling.empty()) return {};
    steps_ = OpsInOrder(facts_, calls_, accesses_, first_scan_).of(0);
    for (std::uint32_t i = 0; i < calls_.nodes.size(); ++i)
      if (!calls_.nodes[i].events.empty()) with_interrupt(i);
    std::ranges::sort(races_, {}, [](const Race& race) { return std::tuple(race.first, race.last, race.interrupt); });
    return std::move(races_);
  }

 private:
  /// An access of an interrupt routine.
  struct Foreign {
    std::uint32_t op = 0;
    Access access;
  };

  void with_interrupt(std::uint32_t routine) {
    interrupt_ = routine;
    foreign_.clear();
    std::set<std::tuple<std::uint32_t, std::uint64_t, std::uint64_t, Role>> known;  // a routine may be called often
    const std::vector<bool> nothing(facts_.program.ops.size());
    for (const PlacedOp& step : OpsInOrder(facts_, calls_, accesses_, nothing).of(routine))
      for (const Access& access : step.accesses)
        if (access.bits.count != 0 && !access.anywhere && is_shared(access.bits) &&
            known.emplace(step.op, access.bits.first, access.bits.count, access.role).second)
          foreign_.push_back({step.op, access});
    if (foreign_.empty()) return;
    for (std::size_t step = 0; step < steps_.size() && !waiter_.asks_to_end(); ++step) {
      if (is_unread(op(step))) continue;
      for (const Access& access : steps_[step].accesses) {
        if (access.bits.count == 0 || !is_shared(access.bits) || !writer_of(access.bits)) continue;
        if (access.role == Role::In) follow(step, access);
        if (access.role == Role::Out && !access.somewhere) keep(step, access);
      }
    }
    find_torn(Race::Kind::TornRead);
    find_torn(Race::Kind::TornWrite);
  }

  const Op& op(std::size_t step) const { return facts_.program.ops[steps_[step].op]; }

  /// Whether a box or a coil has power flow in the first scan only.
  bool is_of_first_scan(std::size_t step) const { return !op(step).is_contact && first_scan_[steps_[step].op]; }

  struct Pair {
    std::size_t first = 0, last = 0;
  };

  void add(Race::Kind kind, const Bits& bits, const Pair& steps, const Foreign& foreign, bool suspected) {
    const std::uint32_t first = steps_[steps.first].op, last = steps_[steps.last].op;
    if (is_of_first_scan(steps.first) || is_of_first_scan(steps.last)) return;
    const auto& events = calls_.nodes[interrupt_].events;
    const auto event =
        std::ranges::find_if(events, [&](std::uint8_t each) { return !protection_.covers(steps.first, steps.last, each); });
    if (event == events.end()) return;
    const auto known = std::ranges::find_if(races_, [&](const Race& race) {
      return race.routine == interrupt_ && race.last == last && race.kind == kind && race.bits == as_named(bits);
    });
    if (known == races_.end())
      races_.push_back({kind, as_named(bits), first, last, foreign.op, interrupt_, *event, suspected});
    else if (known->suspected && !suspected)
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
    const std::size_t end = std::min(steps_.size(), reader + kFarthest);
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
    return std::ranges::any_of(steps_[step].accesses, [&](const Access& access) {
      return access.reads() && access.bits.count != 0 && overlaps_any(dependent, access.bits);
    });
  }

  /// Whether a box reads and writes it again in one go, or reads it for what follows.
  bool rereads(std::size_t step, const Bits& shared) const {
    return std::ranges::any_of(steps_[step].accesses, [&](const Access& access) {
      return access.role == Role::In && access.of_operand && access.bits == shared;
    });
  }

  /// What a step writes of memory that was read. Of bits that are set or reset nothing depends on their old value.
  const Access* write_back(std::size_t step, const Access& read) const {
    for (const Access& access : steps_[step].accesses) {
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
    const std::uint32_t first = steps_[reader].op, last = steps_[writer].op;
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
    for (const Access& access : steps_[step].accesses)
      if (access.writes() && access.of_operand && access.bits.count != 0 && !overlaps_whole(dependent, access.bits))
        dependent.push_back(access.bits);
  }
  static bool overlaps_whole(const std::vector<Bits>& all, const Bits& bits) {
    return std::ranges::any_of(all, [&](const Bits& each) { return each.contains(bits); });
  }

  void forget_overwritten(std::size_t step, std::vector<Bits>& dependent) const {
    for (const Access& access : steps_[step].accesses)
      if (access.role == Role::Out && access.certain)
        std::erase_if(dependent, [&](const Bits& bits) { return access.bits.contains(bits); });
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
    const std::size_t end = std::min(steps_.size(), writer + kFarthest);
    std::optional<std::size_t> changed;
    for (std::size_t step = writer + 1; step < end; ++step) {
      if (is_unread(op(step))) return;
      for (const Access& access : steps_[step].accesses) {
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

  bool leads(std::size_t step, const Bits& pointer) const {
    return std::ranges::any_of(steps_[step].accesses, [&](const Access& access) {
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
    for (std::size_t step = 0; is_new && step < steps_.size(); ++step)
      for (const Access& access : steps_[step].accesses) {
        if (!access.bits.overlaps(bits) || access.somewhere || is_of_first_scan(step)) continue;
        return answer->second = access.reads();
      }
    return answer->second;
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
      for (std::size_t step = 0; step < steps_.size(); ++step) {
        const auto part = part_of(step, whole, reads);
        const std::uint32_t call = steps_[step].call;
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
    for (const Access& access : steps_[step].accesses) {
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
  std::vector<PlacedOp> steps_{};  // of the main program
  Protection protection_;
  std::uint32_t interrupt_ = 0;
  std::vector<Foreign> foreign_{};
  std::map<std::pair<std::uint64_t, std::uint64_t>, bool> read_first_{};  // what is_read_first() has answered
  std::vector<Race> races_{};
};

}  // namespace

std::vector<Race> find_races(const Facts& facts, const Calls& calls, const Waiter& waiter) {
  return RaceFinder(facts, calls, waiter).all();
}

}  // namespace s7200
