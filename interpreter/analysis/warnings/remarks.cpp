#include "interpreter/analysis/warnings/remarks.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "interpreter/analysis/effects/memory_names.hpp"
#include "interpreter/analysis/effects/pointers.hpp"
#include "interpreter/analysis/effects/value_boxes.hpp"
#include "interpreter/analysis/flow/calls.hpp"
#include "interpreter/analysis/flow/first_scan.hpp"
#include "interpreter/analysis/flow/paths.hpp"
#include "interpreter/analysis/warnings/lint_ops.hpp"
#include "interpreter/base/text/among.hpp"
#include "interpreter/model/ports.hpp"
#include "interpreter/program/loading/unread.hpp"

namespace s7200 {
namespace {

class RemarkFinder {
 public:
  RemarkFinder(const Facts& facts, const CrossReference& reference) : facts_(facts), reference_(reference) {}

  std::vector<Remark> all() {
    find_one_sided();
    find_shared();
    for (std::uint32_t op = 0; op < facts_.program.ops.size(); ++op) find_past_symbol(op);
    for (std::uint32_t op = 0; op < facts_.program.ops.size(); ++op) find_full_room(op);
    find_written_twice();
    for (std::uint32_t op = 0; op < facts_.program.ops.size(); ++op) find_switched_off(op);
    std::ranges::stable_sort(remarks_, {}, [](const Remark& remark) { return std::tuple(remark.kind, remark.bits.first); });
    return std::move(remarks_);
  }

 private:
  const Op& op_of(std::uint32_t op) const { return facts_.program.ops[op]; }

  // --- bits that S or R alone write ---

  struct Sides {
    std::vector<std::uint32_t> set, reset;
  };

  void find_one_sided() {
    std::map<std::uint64_t, Sides> bits;
    for (std::uint32_t op = 0; op < facts_.program.ops.size(); ++op) {
      const std::string_view mnemonic = op_of(op).instruction->mnemonic;
      const bool sets = is_among(mnemonic, {"S", "SI"}), resets = is_among(mnemonic, {"R", "RI"});
      if (!(sets || resets) || op_of(op)[0].pointer) continue;
      for (const MemoryAccess& access : facts_.effects[op]) {
        if (!access.writes() || access.operand != 0 || access.certainty != Certainty::Must) continue;
        for (std::uint64_t bit = access.bits.first; bit < access.bits.end(); ++bit)
          (sets ? bits[bit].set : bits[bit].reset).push_back(op);
      }
    }
    for (const auto& [bit, sides] : bits) add_one_sided({bit, 1}, sides);
  }

  void add_one_sided(const Bits& bit, const Sides& sides) {
    constexpr Areas kOwn = set_of(Area::Q) | set_of(Area::M) | set_of(Area::V);
    const bool one_sided = sides.set.empty() != sides.reset.empty();
    if (!one_sided || !contains(kOwn, area_of(as_named(bit))) || is_written_otherwise(bit) || !is_looked_at(bit)) return;
    if (sides.reset.empty())
      remarks_.push_back({Remark::Kind::NeverReset, bit, {}, sides.set});
    else
      remarks_.push_back({Remark::Kind::NeverSet, bit, {}, sides.reset});
  }

  bool is_written_otherwise(const Bits& bit) const {
    for (std::uint32_t op = 0; op < facts_.effects.size(); ++op) {
      const bool sets_or_resets = is_among(op_of(op).instruction->mnemonic, {"S", "SI", "R", "RI"});
      for (const MemoryAccess& access : facts_.effects[op])
        if (access.writes() && access.bits.overlaps(bit) && !is_point(access) && !(sets_or_resets && access.operand == 0))
          return true;
    }
    return is_set_by_data_block(facts_.program, bit);
  }
  /// The output point that SI writes beside its image.
  static bool is_point(const MemoryAccess& access) { return access.operand == kNoOperand && !access.by_pointer; }

  /// Outputs are looked at by the field.
  bool is_looked_at(const Bits& bit) const {
    if (area_of(as_named(bit)) == Area::Q) return true;
    for (std::uint32_t op = 0; op < facts_.effects.size(); ++op)
      for (const MemoryAccess& access : facts_.effects[op])
        if (op_of(op).is_contact && access.reads() && !access.by_pointer && access.bits.overlaps(bit)) return true;
    return false;
  }

  // --- outputs in several places ---

  void find_written_twice() {
    const Calls calls = calls_of(facts_.program, facts_.flow);
    Paths paths(facts_.program, facts_.flow);
    std::map<std::uint64_t, std::vector<std::uint32_t>> coils;  // of outputs, by bit
    for (const std::uint32_t coil : lint::ops_with(facts_.program, Effect::Coil))
      if (const Bits bit = bits_of(facts_.program, op_of(coil), 0); area_of(bit) == Area::Q)
        coils[bit.first].push_back(coil);
    for (const auto& [bit, ops] : coils) add_other_coil({bit, 1}, ops, paths, calls);
    const std::vector<bool> first_scan = coils.empty() ? std::vector<bool>{} : ops_of_first_scan(facts_.program);
    for (std::uint32_t op = 0; op < facts_.program.ops.size() && !coils.empty(); ++op)
      if (!first_scan[op]) add_written_whole(op, coils, paths);
  }

  void add_other_coil(const Bits& bit, const std::vector<std::uint32_t>& coils, Paths& paths, const Calls& calls) {
    const auto always = std::ranges::find_if(coils, [&](std::uint32_t coil) { return paths.in_every_scan(coil); });
    if (always == coils.end()) return;
    std::vector<std::uint32_t> ops{*always};
    for (const std::uint32_t coil : coils) {
      const std::uint32_t routine = paths.routine(coil);
      if (routine != 0 && routine != paths.routine(*always) && calls.nodes[routine].by_main && !paths.in_every_scan(coil))
        ops.push_back(coil);
    }
    if (ops.size() > 1) remarks_.push_back({Remark::Kind::OtherCoil, bit, {}, std::move(ops)});
  }

  /// 0 switches all off, in an emergency or in the first scan: it is meant so.
  void add_written_whole(std::uint32_t op, const std::map<std::uint64_t, std::vector<std::uint32_t>>& coils,
                         const Paths& paths) {
    const auto rules = op_of(op).instruction->rules();
    const bool clears = !rules.empty() && constant_value(facts_.program, op_of(op)[0], rules[0].width) == 0;
    if (facts_.flow.nodes[op].powered || clears) return;
    for (const MemoryAccess& access : facts_.effects[op]) {
      const bool whole = access.role == Role::Out && access.operand != kNoOperand && access.bits.count >= 8;
      if (!whole || access.by_pointer || area_of(access.bits) != Area::Q) continue;
      for (auto bit = coils.lower_bound(access.bits.first); bit != coils.end() && bit->first < access.bits.end(); ++bit) {
        const auto coil =
            std::ranges::find_if(bit->second, [&](std::uint32_t each) { return each < op && paths.leads_to(each, op); });
        if (coil == bit->second.end()) continue;
        remarks_.push_back({Remark::Kind::WrittenWhole, {bit->first, 1}, {}, {*coil, op}});
        return;
      }
    }
  }

  /// A second LDN SM0.0 in front of a counter is an input that it does not use.
  void find_switched_off(std::uint32_t op) {
    const Op& contact = op_of(op);
    if (contact.instruction->mnemonic != "LDN" || contact[0].pointer || op + 1 == facts_.program.ops.size()) return;
    const Rung& next = op_of(op + 1).instruction->rung;
    const bool alone = next.writes_output && next.stack == StackUse{.needs = 1, .change = 0};
    if (contact[0].at == sm::kScanStatus && contact[0].bit == 0 && alone)
      remarks_.push_back({Remark::Kind::SwitchedOff, {sm::kScanStatus * 8u, 1}, {}, {op, op + 1}});
  }

  // --- symbols ---

  struct Named {
    std::string name;
    Bits bits;
  };

  std::vector<Named> symbols() const {
    std::vector<Named> all;
    for (const stl::Symbol& symbol : facts_.program.source.symbols)
      if (const auto bits = bits_of(facts_.program, symbol))
        if (area_of(*bits) == Area::V || area_of(*bits) == Area::M) all.push_back({symbol.name, *bits});
    std::ranges::stable_sort(all, {}, [](const Named& named) { return named.bits.first; });
    return all;
  }

  /// The instructions that name exactly these bits.
  std::vector<std::uint32_t> users_of(const Bits& bits) const {
    std::vector<std::uint32_t> ops;
    for (const ReferenceEntry& entry : reference_.entries)
      for (const Use& use : entry.uses)
        if (use.access.bits == bits) ops.push_back(use.op);
    return ops;
  }

  void find_shared() {
    const std::vector<Named> all = symbols();
    for (const Named& outer : all)
      for (const Named& inner : all) {
        const bool apart = !inner.bits.overlaps(outer.bits) || inner.bits == outer.bits || inner.bits.count == 1;
        const bool other_way = inner.bits.count > outer.bits.count ||
                               (inner.bits.count == outer.bits.count && inner.bits.first < outer.bits.first);
        if (apart || other_way || outer.bits.count > 32) continue;
        std::vector<std::uint32_t> ops = users_of(outer.bits);
        const std::vector<std::uint32_t> inside = users_of(inner.bits);
        if (ops.empty() || inside.empty()) continue;
        ops.resize(1);
        ops.push_back(inside.front());
        remarks_.push_back({Remark::Kind::SharedMemory, inner.bits, {outer.name, inner.name}, std::move(ops)});
      }
  }

  void find_past_symbol(std::uint32_t op) {
    if (is_unread(op_of(op))) return;
    for (const MemoryAccess& access : facts_.effects[op]) {
      if (!access.writes() || access.by_pointer || access.operand == kNoOperand || access.certainty != Certainty::Must)
        continue;
      const OperandRule& rule = op_of(op).instruction->operand[access.operand];
      if (rule.counted == 0 || rule.width == Width::Bit) continue;
      const std::vector<std::string> names = symbols_from(access.bits);
      if (names.size() > 1) remarks_.push_back({Remark::Kind::PastItsSymbol, access.bits, names, {op}});
    }
  }

  void find_full_room(std::uint32_t op) {
    const auto room = room_of(op);
    if (!room) return;
    const std::vector<std::string> names = symbols_from(*room);
    if (names.size() > 1) remarks_.push_back({Remark::Kind::MayPassItsSymbol, *room, names, {op}});
  }

  /// The memory of the longest message of RCV, or of the table of ATT when it is full, as constants say.
  std::optional<Bits> room_of(std::uint32_t op) const {
    const Op& of = op_of(op);
    if (is_unread(of)) return {};
    if (of.instruction->effect == Effect::Receives && !of[0].pointer) {
      const auto most = most_put_into(kPorts[of[1].at].message + sm::message::kMost, Width::Byte);
      return most ? std::optional(Bits{of[0].at * std::uint64_t{8}, 8 * (1 + std::uint64_t(*most))}) : std::nullopt;
    }
    if (of.instruction->mnemonic != "ATT" || of[1].pointer) return {};
    constexpr std::uint64_t kHead = 2;  // words: most entries, entries
    const auto most = most_put_into(of[1].at, Width::Word);
    return most ? std::optional(Bits{of[1].at * std::uint64_t{8}, 16 * (kHead + std::uint64_t(*most))}) : std::nullopt;
  }

  /// The largest number that constants and the data block put into a byte or a word; nothing without one above 0, or if
  /// something else is put there.
  std::optional<std::int64_t> most_put_into(std::uint32_t at, Width width) const {
    auto all = constants_written(facts_, at, width);
    if (!all) return {};
    for (const InitialData& data : facts_.program.data) {
      const std::uint32_t begin = image::kV + data.offset;
      if (at < begin || at + bytes_of(width) > begin + data.bytes.size()) continue;
      std::int64_t value = 0;
      for (std::uint32_t i = 0; i < bytes_of(width); ++i) value = value << 8 | data.bytes[at - begin + i];
      all->push_back(value);
    }
    const auto most = std::ranges::max_element(*all);
    return most == all->end() || *most <= 0 ? std::nullopt : std::optional(*most);
  }

  /// A symbol that stands for the start of a block, and those of the memory after it; nothing without the first.
  std::vector<std::string> symbols_from(const Bits& block) const {
    const std::vector<Named> all = symbols();
    const auto first = std::ranges::find(all, block.first, [](const Named& named) { return named.bits.first; });
    if (first == all.end()) return {};
    std::vector<std::string> names{first->name};
    for (const Named& symbol : all)
      if (symbol.bits.overlaps(block) && symbol.bits.first >= first->bits.end()) names.push_back(symbol.name);
    return names;
  }

  const Facts& facts_;
  const CrossReference& reference_;
  std::vector<Remark> remarks_{};
};

}  // namespace

std::vector<Remark> remarks_of(const Facts& facts, const CrossReference& reference) {
  if (has_unread(facts.program)) return {};
  return RemarkFinder(facts, reference).all();
}

}  // namespace s7200
