#include "interpreter/analysis/cross_reference.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <tuple>
#include <utility>

#include "interpreter/analysis/effects/fast_units.hpp"
#include "interpreter/analysis/effects/memory_names.hpp"
#include "interpreter/program/loading/unread.hpp"
#include "interpreter/stl/printer.hpp"

namespace s7200 {
namespace {

constexpr std::array kOrder{Area::I, Area::Q, Area::AI, Area::AQ, Area::V,  Area::M, Area::SM,
                            Area::S, Area::T, Area::C,  Area::HC, Area::AC, Area::L};
constexpr std::uint64_t kWidest = 32;  ///< bits of an operand that is not a block

auto order_of(const Bits& bits) { return std::ranges::find(kOrder, area_of(bits)) - kOrder.begin(); }

bool is_local(const Bits& bits) { return Bits{image::kL * 8u, 64 * 8}.overlaps(bits); }

/// What the cross reference has nothing to say about: memory bits of EU and ED, flags, the local memory that a CALL
/// clears, the accumulators that RETI restores.
bool is_left_out(const MemoryAccess& access) {
  const Bits edges{image::kEdges * 8u, 512 * 8}, flags{sm::kFlags * 8u, 8}, errors{sm::kInterruptStatus * 8u + 3, 1};
  const bool everything = access.bits.count > image::kConstants * 7u, cleared = access.bits == Bits{image::kL * 8u, 64 * 8},
             restored = access.bits == Bits{image::kAC * 8u, 4 * 32};
  if (everything || edges.contains(access.bits)) return true;
  return access.operand == kNoOperand && (cleared || restored || flags.contains(access.bits) || errors == access.bits);
}

bool is_call_or_return(const Instruction& instruction) {
  return instruction.structure == Structure::Call || instruction.structure == Structure::SubroutineEnd ||
         instruction.effect == Effect::ConditionalEnd;
}

/// Whether an access is that of an operand which names all of what it accesses; S V0.0, 1 does as much as a coil.
bool is_plain(const Op& op, const MemoryAccess& access) {
  if (access.by_pointer || access.bits.count > kWidest) return false;
  const std::uint64_t single = std::max(1u, info(area_of(access.bits)).element * 8);
  if (access.certainty == Certainty::Must && access.bits.count == single) return true;
  if (access.operand == kNoOperand)
    return is_call_or_return(*op.instruction) || op.instruction->hidden == Hidden::SegmentBit;
  const OperandRule& rule = op.instruction->operand[access.operand];
  return op.instruction->structure == Structure::Next || (rule.counted == 0 && rule.most == 0 && rule.elements == 1);
}

/// The accesses of an op to memory as it is named, each once: a timer's bit and its value are one.
std::vector<MemoryAccess> named_accesses(const std::vector<MemoryAccess>& effects) {
  std::vector<MemoryAccess> named;
  for (MemoryAccess access : effects) {
    if (is_left_out(access)) continue;
    access.bits = as_named(access.bits);
    const auto same = std::ranges::find_if(named, [&](const MemoryAccess& other) {
      return other.bits == access.bits && other.by_pointer == access.by_pointer &&
             (other.operand == access.operand || access.operand == kNoOperand);
    });
    if (same == named.end())
      named.push_back(access);
    else if (same->role != access.role)
      same->role = Role::InOut;
  }
  return named;
}

struct Key {
  std::optional<std::uint32_t> routine;
  std::uint64_t first = 0;
  auto operator<=>(const Key&) const = default;
};

class UseCollector {
 public:
  explicit UseCollector(const Facts& facts) : facts_(facts) {}

  CrossReference all() {
    for (std::uint32_t op = 0; op < facts_.effects.size(); ++op) add(op);
    join();
    for (const Use& use : others_)
      if (!use.access.by_pointer && first_reached(use) == end_reached(use)) own_entry(use).uses.push_back(use);
    for (const Use& use : others_) spread(use);
    for (ReferenceEntry& entry : result_.entries) finish(entry);
    std::ranges::stable_sort(result_.entries, {}, [](const ReferenceEntry& entry) {
      return std::tuple(order_of(entry.bits), entry.routine, entry.bits.first);
    });
    add_pointers();
    add_constants();
    add_symbols();
    return std::move(result_);
  }

 private:
  std::optional<std::uint32_t> scope(const Use& use) const {
    if (!is_local(use.access.bits)) return {};
    return facts_.flow.nodes[use.op].routine;
  }

  void add(std::uint32_t op) {
    if (is_unread(facts_.program.ops[op])) return result_.unread.push_back(op);
    const bool returns = facts_.program.ops[op].instruction->structure != Structure::Call;
    for (const MemoryAccess& access : named_accesses(facts_.effects[op])) {
      // What a subroutine hands back to its caller's local memory is listed with the CALL.
      if (returns && access.operand == kNoOperand && is_local(access.bits)) continue;
      (is_plain(facts_.program.ops[op], access) ? plain_ : others_).push_back({op, access});
    }
  }

  /// Makes entries of the plain accesses that overlap.
  void join() {
    std::ranges::stable_sort(plain_, {}, [&](const Use& use) { return Key{scope(use), use.access.bits.first}; });
    for (const Use& use : plain_) {
      const bool goes_on = !result_.entries.empty() && result_.entries.back().routine == scope(use) &&
                           result_.entries.back().bits.end() > use.access.bits.first;
      if (!goes_on) begin(use);
      ReferenceEntry& entry = result_.entries.back();
      entry.bits.count = std::max(entry.bits.end(), use.access.bits.end()) - entry.bits.first;
      entry.uses.push_back(use);
    }
    joined_ = result_.entries.size();
  }

  void begin(const Use& use) { result_.entries.push_back({use.access.bits, scope(use), {}, {}, {}, {}}); }

  // The entries of plain accesses are in order, so those that an access may reach stand together.

  std::size_t first_reached(const Use& use) const {
    const auto joined = result_.entries.begin() + static_cast<std::ptrdiff_t>(joined_);
    const Key key{scope(use), use.access.bits.first};
    const auto first =
        std::lower_bound(result_.entries.begin(), joined, key, [](const ReferenceEntry& each, const Key& wanted) {
          return Key{each.routine, each.bits.end()} <= wanted;
        });
    return static_cast<std::size_t>(first - result_.entries.begin());
  }
  std::size_t end_reached(const Use& use) const {
    std::size_t entry = first_reached(use);
    while (entry < joined_ && result_.entries[entry].routine == scope(use) &&
           result_.entries[entry].bits.first < use.access.bits.end())
      ++entry;
    return entry;
  }

  /// Lists an access with the entries that it may reach.
  void spread(const Use& use) {
    const std::size_t end = end_reached(use);
    for (std::size_t entry = first_reached(use); entry < end; ++entry) result_.entries[entry].reached.push_back(use);
    for (std::size_t block = joined_; block < result_.entries.size(); ++block) {
      ReferenceEntry& entry = result_.entries[block];
      const bool own = !use.access.by_pointer && entry.bits == use.access.bits;
      if (!own && entry.routine == scope(use) && entry.bits.overlaps(use.access.bits)) entry.reached.push_back(use);
    }
  }

  /// The entry of a block that is no part of another one.
  ReferenceEntry& own_entry(const Use& use) {
    const auto joined = result_.entries.begin() + static_cast<std::ptrdiff_t>(joined_);
    const auto same = std::find_if(joined, result_.entries.end(), [&](const ReferenceEntry& each) {
      return each.routine == scope(use) && each.bits == use.access.bits;
    });
    if (same != result_.entries.end()) return *same;
    begin(use);
    return result_.entries.back();
  }

  static void finish(ReferenceEntry& entry) {
    for (const Use& use : entry.uses) entry.parts.push_back(use.access.bits);
    std::ranges::sort(entry.parts, {}, [](const Bits& bits) { return std::pair(bits.first, ~bits.count); });
    entry.parts.erase(std::unique(entry.parts.begin(), entry.parts.end()), entry.parts.end());
    std::ranges::stable_sort(entry.uses, {}, &Use::op);
    std::ranges::stable_sort(entry.reached, {}, &Use::op);
  }

  void add_pointers() {
    std::map<std::pair<std::optional<std::uint32_t>, std::uint32_t>, PointerEntry> pointers;
    for (const Use& use : others_) {
      const auto pointer = pointer_of(facts_.program, use.op, use.access);
      if (!pointer) continue;
      const std::uint32_t at = *pointer;
      const bool local = at >= image::kL && at < image::kConstants;
      const auto routine = local ? std::optional(facts_.flow.nodes[use.op].routine) : std::nullopt;
      PointerEntry& entry = pointers.try_emplace({routine, at}, PointerEntry{at, routine, {}, {}, {}}).first->second;
      const bool is_operand = use.access.operand != kNoOperand;
      if (!entry.unknown)
        entry.unknown = is_operand ? facts_.pointers.unknown(use.op, at) : unknown_profile(facts_, use.op);
      if (std::ranges::find(entry.targets, use.access.bits) == entry.targets.end()) entry.targets.push_back(use.access.bits);
      if (entry.ops.empty() || entry.ops.back() != use.op) entry.ops.push_back(use.op);
    }
    for (auto& [key, entry] : pointers) {
      std::ranges::sort(entry.targets, {}, &Bits::first);
      result_.pointers.push_back(std::move(entry));
    }
  }

  void add_constants() {
    std::map<std::pair<std::int64_t, std::string>, ConstantEntry> constants;
    for (std::uint32_t op = 0; op < facts_.program.ops.size(); ++op) {
      if (is_unread(facts_.program.ops[op])) continue;
      const Instruction& instruction = *facts_.program.ops[op].instruction;
      const auto& operands = facts_.program.statement(op).operands;
      for (std::size_t i = 0; i < operands.size(); ++i) {
        const bool number = i < instruction.rules().size() && instruction.operand[i].kind != OperandKind::Memory;
        const bool address = std::holds_alternative<stl::Address>(operands[i].value) ||
                             std::holds_alternative<stl::Indirect>(operands[i].value) ||
                             std::holds_alternative<stl::Name>(operands[i].value);
        if (number || address) continue;
        const auto* integer = std::get_if<stl::Integer>(&operands[i].value);
        const std::string text = stl::to_text(operands[i]);
        ConstantEntry& entry = constants[{integer ? integer->value : INT64_MAX, integer ? "" : text}];
        if (entry.text.empty()) entry.text = text;
        entry.places.push_back({op, static_cast<std::uint8_t>(i)});
      }
    }
    for (auto& [key, entry] : constants) result_.constants.push_back(std::move(entry));
  }

  void add_symbols() {
    for (const stl::Symbol& symbol : facts_.program.source.symbols) {
      const auto bits = bits_of(facts_.program, symbol);
      if (!bits) continue;
      bool used = false;
      for (ReferenceEntry& entry : result_.entries) {
        if (!entry.bits.overlaps(*bits)) continue;
        entry.symbols.push_back(symbol.name);
        used = true;
      }
      if (!used) result_.unused_symbols.push_back(symbol.name);
    }
  }

  const Facts& facts_;
  std::vector<Use> plain_{}, others_{};
  std::size_t joined_ = 0;  // entries of plain accesses, which come first
  CrossReference result_{};
};

}  // namespace

CrossReference cross_reference(const Facts& facts) { return UseCollector(facts).all(); }

Usage usage_of(const Program& program, const ReferenceEntry& entry) {
  const Area area = area_of(entry.bits);
  const bool own = area == Area::V || area == Area::M || area == Area::S || area == Area::T || area == Area::C;
  if (!own) return Usage::Both;
  bool looked_at = false, changed = false, written = false;
  for (const std::vector<Use>* uses : {&entry.uses, &entry.reached})
    for (const Use& use : *uses) {
      looked_at |= use.access.role == Role::In;
      changed |= use.access.role == Role::InOut;
      written |= use.access.writes();
    }
  const bool by_data = std::ranges::any_of(program.data, [&](const InitialData& data) {
    return entry.bits.overlaps({(image::kV + data.offset) * 8u, data.bytes.size() * 8});
  });
  if (looked_at) return written ? Usage::Both : by_data ? Usage::SetByData : Usage::NeverWritten;
  return changed ? Usage::OnlyChanged : Usage::NeverRead;
}

bool is_anywhere(const Program& program, const MemoryAccess& access) {
  if (!access.by_pointer) return false;
  const Bits area = bits_of_area(*program.model, area_of(access.bits));
  return access.bits.first == area.first && access.bits.count >= area.count;
}

}  // namespace s7200
