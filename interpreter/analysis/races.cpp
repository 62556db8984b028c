#include "interpreter/analysis/races.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string_view>
#include <tuple>

#include "interpreter/analysis/effects/memory_names.hpp"
#include "interpreter/analysis/flow/first_scan.hpp"
#include "interpreter/base/bytes.hpp"
#include "interpreter/program/loading/unread.hpp"

namespace s7200 {
namespace {

constexpr std::uint64_t kBitsOfByte = 8, kBitsOfWord = 16, kBitsOfDouble = 32;
constexpr std::uint32_t kFarthest = 300;  ///< ops between a read and a write that depends on it

bool is_shared(const Bits& bits) {
  constexpr Areas kShared =
      set_of(Area::V) | set_of(Area::M) | set_of(Area::S) | set_of(Area::Q) | set_of(Area::T) | set_of(Area::C);
  return contains(kShared, area_of(bits));
}

Bits overlap_of(const Bits& a, const Bits& b) {
  const std::uint64_t first = std::max(a.first, b.first), end = std::min(a.end(), b.end());
  return {first, end > first ? end - first : 0};
}

/// Where the accesses of ops are, as exactly as the program says.
class Accesses {
 public:
  explicit Accesses(const Facts& facts) : facts_(facts) {
    for (std::uint32_t op = 0; op < facts.effects.size(); ++op) {
      std::vector<MemoryAccess> of_op;
      for (MemoryAccess access : facts.effects[op]) {
        if (is_table(op, access)) continue;
        if (access.by_pointer) access.bits = through_pointer(op, access);
        if (access.bits.count != 0 && access.bits.count <= 8 * 255) of_op.push_back(access);
      }
      all_.push_back(std::move(of_op));
    }
  }

  const std::vector<MemoryAccess>& of(std::uint32_t op) const { return all_[op]; }

 private:
  /// Whether memory says how far an access goes: a message of XMT and RCV, which the system sends and stores, or a table.
  bool is_table(std::uint32_t op, const MemoryAccess& access) const {
    return access.operand != kNoOperand && facts_.program.ops[op].instruction->operand[access.operand].most != 0;
  }

  /// What an access through a pointer is of; nothing if that is not known.
  Bits through_pointer(std::uint32_t op, const MemoryAccess& access) const {
    if (access.bits.count <= kBitsOfDouble) return access.bits;
    if (access.operand == kNoOperand) return {};
    const auto places = facts_.pointers.targets(op, facts_.program.ops[op][access.operand].at);
    const bool at_one_place = places.size() == 1 && places.front().to == places.front().from + 1;
    return at_one_place ? access.bits : Bits{0, 0};
  }

  const Facts& facts_;
  std::vector<std::vector<MemoryAccess>> all_{};
};

/// Ops during which DISI surely keeps interrupts away.
class Protection {
 public:
  Protection(const Facts& facts, const Calls& calls) : facts_(facts), calls_(calls) {}

  /// Whether no interrupt comes between two ops of a routine.
  bool covers(std::uint32_t first, std::uint32_t last) const {
    const Routine& routine = facts_.flow.routine_of(first);
    if (contains_enabling(first, last)) return false;
    for (std::uint32_t i = first; i-- > routine.first;) {
      if (is_enabling(i)) return false;
      if (facts_.program.ops[i].instruction->mnemonic == "DISI") return is_executed_with(i, first);
    }
    return called_protected(facts_.flow.nodes[first].routine, 0);
  }

 private:
  bool is_enabling(std::uint32_t op) const {
    return facts_.program.ops[op].instruction->effect == Effect::EnablesInterrupts;
  }
  bool contains_enabling(std::uint32_t first, std::uint32_t last) const {
    return std::ranges::any_of(calls_.enabling, [&](std::uint32_t op) { return op >= first && op < last; });
  }

  /// Whether DISI has power flow whenever `op`, later in the routine, has.
  bool is_executed_with(std::uint32_t disi, std::uint32_t op) const {
    if (facts_.flow.nodes[disi].powered) return !leads_past(disi, op);
    for (std::uint32_t i = disi + 1; i < op; ++i) {
      const Op& between = facts_.program.ops[i];
      const std::string_view mnemonic = between.instruction->mnemonic;
      const bool only_takes_power = mnemonic.starts_with('A') && mnemonic != "ALD";
      if (between.is_contact && !only_takes_power) return false;
      if (between.instruction->structure != Structure::None) return false;
    }
    return true;
  }

  /// Whether a label, to which a jump may come past DISI, is between them.
  bool leads_past(std::uint32_t disi, std::uint32_t op) const {
    for (std::uint32_t i = disi + 1; i <= op; ++i)
      if (facts_.program.ops[i].instruction->structure == Structure::Label) return true;
    return false;
  }

  bool called_protected(std::uint32_t routine, std::size_t depth) const {
    const auto& called = calls_.nodes[routine].called;
    if (called.empty() || depth > facts_.flow.routines.size()) return false;
    return std::ranges::all_of(called, [&](const CallSite& site) {
      if (!calls_.nodes[site.routine].by_main) return true;
      const Routine& caller = facts_.flow.routines[site.routine];
      for (std::uint32_t i = site.op; i-- > caller.first;) {
        if (is_enabling(i)) return false;
        if (facts_.program.ops[i].instruction->mnemonic == "DISI") return is_executed_with(i, site.op);
      }
      return called_protected(site.routine, depth + 1);
    });
  }

  const Facts& facts_;
  const Calls& calls_;
};

class RaceFinder {
 public:
  RaceFinder(const Facts& facts, const Calls& calls, const Waiter& waiter)
      : facts_(facts),
        calls_(calls),
        waiter_(waiter),
        accesses_(facts),
        protection_(facts, calls),
        first_scan_(ops_of_first_scan(facts.program)) {}

  std::vector<Race> all() {
    if (calls_.enabling.empty()) return {};
    for (std::uint32_t i = 0; i < calls_.nodes.size(); ++i)
      if (!calls_.nodes[i].events.empty()) with_interrupt(i);
    std::ranges::sort(races_, {}, [](const Race& race) { return std::tuple(race.first, race.last, race.interrupt); });
    return std::move(races_);
  }

 private:
  /// An access of an interrupt routine.
  struct Foreign {
    std::uint32_t op = 0;
    MemoryAccess access;
  };

  void with_interrupt(std::uint32_t routine) {
    interrupt_ = routine;
    foreign_.clear();
    std::set<std::uint32_t> seen;
    collect(routine, seen);
    for (std::uint32_t i = 0; i < calls_.nodes.size(); ++i) {
      if (!calls_.nodes[i].by_main) continue;
      find_lost_updates(facts_.flow.routines[i]);
      find_torn(facts_.flow.routines[i], Race::Kind::TornRead);
      find_torn(facts_.flow.routines[i], Race::Kind::TornWrite);
    }
  }

  void collect(std::uint32_t routine, std::set<std::uint32_t>& seen) {
    if (!seen.insert(routine).second) return;
    for (std::uint32_t op = facts_.flow.routines[routine].first; op < facts_.flow.routines[routine].end; ++op)
      for (const MemoryAccess& access : accesses_.of(op))
        if (is_shared(as_named(access.bits))) foreign_.push_back({op, access});
    for (const CallSite& site : calls_.nodes[routine].calls) collect(site.routine, seen);
  }

  void add(Race::Kind kind, const Bits& bits, std::uint32_t first, std::uint32_t last, std::uint32_t interrupt) {
    if (protection_.covers(first, last) || first_scan_[last]) return;
    const bool known = std::ranges::any_of(races_, [&](const Race& race) {
      return race.routine == interrupt_ && race.last == last && race.kind == kind && race.bits == as_named(bits);
    });
    if (!known)
      races_.push_back({kind, as_named(bits), first, last, interrupt, interrupt_, calls_.nodes[interrupt_].events.front()});
  }

  // --- lost updates ---

  /// What the interrupt writes of some bits that are more than one.
  const Foreign* writer_of(const Bits& bits) const {
    const auto found = std::ranges::find_if(
        foreign_, [&](const Foreign& each) { return each.access.writes() && each.access.bits.overlaps(bits); });
    return found == foreign_.end() ? nullptr : &*found;
  }

  void find_lost_updates(const Routine& routine) {
    for (std::uint32_t op = routine.first; op < routine.end; ++op) {
      if (waiter_.asks_to_end()) return;
      if (is_unread(facts_.program.ops[op])) continue;
      for (const MemoryAccess& access : accesses_.of(op))
        if (access.role == Role::In && access.bits.count >= kBitsOfByte && is_shared(as_named(access.bits)) &&
            writer_of(access.bits))
          follow(routine, op, access.bits);
    }
  }

  static bool overlaps_any(const std::vector<Bits>& all, const Bits& bits) {
    return std::ranges::any_of(all, [&](const Bits& each) { return each.overlaps(bits); });
  }

  bool begins_rung(const Op& op) const { return op.is_contact && op.instruction->rung.stack.change > 0; }

  /// Follows what depends on a read of shared memory, until the routine writes that memory or nothing depends on it any
  /// more.
  void follow(const Routine& routine, std::uint32_t reader, const Bits& shared) {
    const Op& first = facts_.program.ops[reader];
    bool decides = first.is_contact;  // whether the power flow of the rung depends on it
    std::vector<Bits> dependent;
    if (!decides) note_writes(reader, dependent);
    const std::uint32_t end = std::min(routine.end, reader + kFarthest);
    for (std::uint32_t op = reader + 1; op < end; ++op) {
      const Op& now = facts_.program.ops[op];
      if (is_unread(now)) return;
      if (now.is_contact && reads_any(op, dependent))
        decides = true;
      else if (begins_rung(now))
        decides = false;
      if (now.is_contact) continue;
      const bool depends = decides || reads_any(op, dependent);
      if (depends && writes_back(reader, op, shared)) return;
      if (rereads(op, shared)) return;  // the later read is the one that counts
      if (!depends) forget_overwritten(op, dependent);
      if (depends) note_writes(op, dependent);
      if (!decides && dependent.empty()) return;
    }
  }

  bool reads_any(std::uint32_t op, const std::vector<Bits>& dependent) const {
    return std::ranges::any_of(accesses_.of(op), [&](const MemoryAccess& access) {
      return access.reads() && overlaps_any(dependent, access.bits);
    });
  }

  /// Whether a box reads and writes it again in one go, or reads it for what follows.
  bool rereads(std::uint32_t op, const Bits& shared) const {
    return std::ranges::any_of(accesses_.of(op), [&](const MemoryAccess& access) {
      return access.role == Role::In && access.operand != kNoOperand && access.bits == shared;
    });
  }

  bool writes_back(std::uint32_t reader, std::uint32_t op, const Bits& shared) {
    for (const MemoryAccess& access : accesses_.of(op)) {
      const Bits both = overlap_of(access.bits, shared);
      if (access.role != Role::Out || both.count < kBitsOfByte) continue;
      if (const Foreign* writer = writer_of(both)) {
        add(Race::Kind::LostUpdate, both, reader, op, writer->op);
        return true;
      }
    }
    return false;
  }

  void note_writes(std::uint32_t op, std::vector<Bits>& dependent) const {
    for (const MemoryAccess& access : accesses_.of(op))
      if (access.writes() && access.operand != kNoOperand && !overlaps_whole(dependent, access.bits))
        dependent.push_back(access.bits);
  }
  static bool overlaps_whole(const std::vector<Bits>& all, const Bits& bits) {
    return std::ranges::any_of(all, [&](const Bits& each) { return each.contains(bits); });
  }

  void forget_overwritten(std::uint32_t op, std::vector<Bits>& dependent) const {
    for (const MemoryAccess& access : accesses_.of(op))
      if (access.role == Role::Out && access.certainty == Certainty::Must)
        std::erase_if(dependent, [&](const Bits& bits) { return access.bits.contains(bits); });
  }

  // --- parts ---

  /// Two ops of the routine, each of which accesses another part of what an op of the interrupt accesses as a whole.
  void find_torn(const Routine& routine, Race::Kind kind) {
    const bool reads = kind == Race::Kind::TornRead;
    for (const Foreign& foreign : foreign_) {
      if (waiter_.asks_to_end()) return;
      const Bits& whole = foreign.access.bits;
      const bool meant = reads ? foreign.access.writes() : foreign.access.reads();
      if (!meant || whole.count < kBitsOfWord || whole.count > kBitsOfDouble) continue;
      std::optional<std::pair<std::uint32_t, Bits>> earlier;
      for (std::uint32_t op = routine.first; op < routine.end; ++op) {
        const auto part = part_of(op, whole, reads);
        if (!part) continue;
        if (earlier && !earlier->second.overlaps(*part)) {
          add(kind, whole, earlier->first, op, foreign.op);
          break;
        }
        earlier = {op, *part};
      }
    }
  }

  std::optional<Bits> part_of(std::uint32_t op, const Bits& whole, bool reads) const {
    if (first_scan_[op]) return {};
    for (const MemoryAccess& access : accesses_.of(op)) {
      const bool meant = reads ? access.role == Role::In : access.role == Role::Out;
      const Bits both = overlap_of(access.bits, whole);
      if (meant && access.operand != kNoOperand && both.count >= kBitsOfByte && both.count < whole.count) return both;
    }
    return {};
  }

  const Facts& facts_;
  const Calls& calls_;
  const Waiter& waiter_;
  Accesses accesses_;
  Protection protection_;
  std::vector<bool> first_scan_;
  std::uint32_t interrupt_ = 0;
  std::vector<Foreign> foreign_{};
  std::vector<Race> races_{};
};

}  // namespace

std::vector<Race> find_races(const Facts& facts, const Calls& calls, const Waiter& waiter) {
  return RaceFinder(facts, calls, waiter).all();
}

}  // namespace s7200
