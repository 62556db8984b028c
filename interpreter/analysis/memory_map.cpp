#include "interpreter/analysis/memory_map.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "interpreter/analysis/effects/memory_names.hpp"
#include "interpreter/analysis/flow/calls.hpp"
#include "interpreter/base/bytes.hpp"

namespace s7200 {
namespace {

/// Areas whose bits are things of their own; in the others a byte is used if one of its bits is.
bool counts_by_bits(Area area) { return area == Area::I || area == Area::Q || area == Area::M || area == Area::S; }

/// The smallest part of an area that may be free while the one beside it is used.
std::uint64_t unit_of(Area area) {
  const AreaInfo& facts = info(area);
  if (facts.element != 0) return facts.element * 8u;
  return counts_by_bits(area) ? 1 : area == Area::AI || area == Area::AQ ? 16 : 8;
}

Bits in_units(const Bits& bits, std::uint64_t base, std::uint64_t unit) {
  const std::uint64_t first = base + (bits.first - base) / unit * unit;
  const std::uint64_t end = base + (bits.end() - base + unit - 1) / unit * unit;
  return {first, end - first};
}

Bits common(const Bits& a, const Bits& b) {
  const std::uint64_t first = std::max(a.first, b.first), end = std::min(a.end(), b.end());
  return {first, end > first ? end - first : 0};
}

Bits bits_of(const InitialData& data) { return {(image::kV + data.offset) * 8u, data.bytes.size() * 8}; }

class MapBuilder {
 public:
  MapBuilder(const Facts& facts, const CrossReference& reference)
      : facts_(facts), reference_(reference), calls_(calls_of(facts.program, facts.flow)) {}

  MemoryMap all() {
    for (const ReferenceEntry& entry : reference_.entries) {
      for (const Use& use : entry.uses) note(entry.routine, use);
      for (const Use& use : entry.reached)
        if (!use.access.by_pointer) note(entry.routine, use);
    }
    for (const InitialData& data : facts_.program.data) note_data(data);
    for (MemoryMap::AreaUse& area : map_.areas) finish(area);
    add_elements();
    add_savers();
    return std::move(map_);
  }

 private:
  MemoryMap::AreaUse& area(Area wanted, std::optional<std::uint32_t> routine) {
    const auto found = std::ranges::find_if(
        map_.areas, [&](const MemoryMap::AreaUse& each) { return each.area == wanted && each.routine == routine; });
    if (found != map_.areas.end()) return *found;
    map_.areas.push_back({wanted, routine, bits_of_area(*facts_.program.model, wanted), {}, {}, {}, {}, {}, {}});
    return map_.areas.back();
  }

  void note(std::optional<std::uint32_t> routine, const Use& use) {
    MemoryMap::AreaUse& of = area(area_of(use.access.bits), routine);
    const Bits bits = common(in_units(use.access.bits, of.all.first, unit_of(of.area)), of.all);
    if (bits.count != 0) of.used.push_back({bits, {facts_.flow.nodes[use.op].routine}, false});
  }

  void note_data(const InitialData& data) {
    const Bits bits = bits_of(data);
    area(Area::V, {}).used.push_back({bits, {}, true});
    MemoryMap::Data of_data{bits, {}};
    for (const ReferenceEntry& entry : reference_.entries)
      for (const auto* uses : {&entry.uses, &entry.reached})
        for (const Use& use : *uses)
          if (use.access.writes() && !use.access.by_pointer && use.access.bits.overlaps(bits) &&
              std::ranges::find(of_data.writers, use.op) == of_data.writers.end())
            of_data.writers.push_back(use.op);
    map_.data.push_back(std::move(of_data));
  }

  /// Joins what touches, and finds what is left.
  void finish(MemoryMap::AreaUse& area) const {
    std::ranges::stable_sort(area.used, {}, [](const MemoryMap::Used& used) { return used.bits.first; });
    area.idle = idle_of(area.used);
    std::vector<MemoryMap::Used> joined;
    std::uint64_t end = area.all.first;
    for (MemoryMap::Used& used : area.used) {
      if (used.bits.first > end) area.free.push_back({end, used.bits.first - end});
      if (joined.empty() || used.bits.first > end)
        joined.push_back(used);
      else
        join(joined.back(), used);
      end = std::max(end, joined.back().bits.end());
    }
    if (end < area.all.end()) area.free.push_back({end, area.all.end() - end});
    area.used = std::move(joined);
    take_out_pointed(area);
    for (const RetentiveRange& range : facts_.program.retentive())
      if (range.area == area.area && range.count != 0) area.retentive.push_back({range.at() * 8u, range.bytes() * 8u});
    for (std::size_t i = 0; i < reference_.pointers.size(); ++i)
      if (std::ranges::any_of(reference_.pointers[i].targets, [&](const Bits& bits) { return bits.overlaps(area.all); }))
        area.pointers.push_back(i);
  }

  bool is_executed(const MemoryMap::Used& used) const {
    const auto executed = [&](std::uint32_t routine) { return calls_.nodes[routine].executed(); };
    return used.by_data || std::ranges::any_of(used.routines, executed);
  }

  /// What is left of the uses by routines that are never executed, without that of others. Both are by address.
  std::vector<MemoryMap::Used> idle_of(const std::vector<MemoryMap::Used>& uses) const {
    std::vector<MemoryMap::Used> idle;
    const auto add = [&](const Bits& bits, const MemoryMap::Used& used) {
      if (!idle.empty() && idle.back().bits.end() >= bits.first)
        join(idle.back(), {bits, used.routines, false});
      else
        idle.push_back({bits, used.routines, false});
    };
    for (const MemoryMap::Used& used : uses) {
      if (is_executed(used)) continue;
      std::uint64_t from = used.bits.first;
      for (const MemoryMap::Used& other : uses) {
        if (!is_executed(other) || !other.bits.overlaps({from, used.bits.end() - from})) continue;
        if (other.bits.first > from) add({from, other.bits.first - from}, used);
        from = std::min(other.bits.end(), used.bits.end());
        if (from == used.bits.end()) break;
      }
      if (from < used.bits.end()) add({from, used.bits.end() - from}, used);
    }
    return idle;
  }

  /// Splits what is free into what pointers may reach and what they do not.
  void take_out_pointed(MemoryMap::AreaUse& area) const {
    struct Reached {
      Bits bits;
      MemoryMap::Through through;
    };
    std::vector<Reached> reached;
    for (std::uint32_t op = 0; op < facts_.effects.size(); ++op)
      for (const MemoryAccess& access : facts_.effects[op]) {
        const Bits named = as_named(access.bits);
        const auto pointer = pointer_of(facts_.program, op, access);
        if (!pointer || !named.overlaps(area.all)) continue;
        if (area.routine && area.routine != facts_.flow.nodes[op].routine) continue;
        reached.push_back({common(in_units(named, area.all.first, unit_of(area.area)), area.all), {op, *pointer}});
      }
    std::vector<Bits> left;
    for (const Bits& free : area.free) {
      std::set<std::uint64_t> ends{free.first, free.end()};
      for (const Reached& each : reached)
        if (each.bits.overlaps(free))
          ends.insert({std::max(free.first, each.bits.first), std::min(free.end(), each.bits.end())});
      for (auto end = std::next(ends.begin()); end != ends.end(); ++end) {
        const Bits part{*std::prev(end), *end - *std::prev(end)};
        std::vector<MemoryMap::Through> through;
        for (const Reached& each : reached)
          if (each.bits.overlaps(part) && (through.empty() || through.back() != each.through))
            through.push_back(each.through);
        append(through.empty() ? left : perhaps_through(area, through).bits, part);
      }
    }
    area.free = std::move(left);
  }

  static MemoryMap::Perhaps& perhaps_through(MemoryMap::AreaUse& area, const std::vector<MemoryMap::Through>& through) {
    const auto same = std::ranges::find(area.perhaps, through, &MemoryMap::Perhaps::through);
    if (same != area.perhaps.end()) return *same;
    area.perhaps.push_back({{}, through});
    return area.perhaps.back();
  }

  static void append(std::vector<Bits>& all, const Bits& part) {
    if (!all.empty() && all.back().end() == part.first)
      all.back().count += part.count;
    else
      all.push_back(part);
  }

  static void join(MemoryMap::Used& into, const MemoryMap::Used& used) {
    into.bits.count = std::max(into.bits.end(), used.bits.end()) - into.bits.first;
    into.by_data |= used.by_data;
    for (const std::uint32_t routine : used.routines)
      if (std::ranges::find(into.routines, routine) == into.routines.end()) into.routines.push_back(routine);
    std::ranges::sort(into.routines);
  }

  void add_elements() {
    const Program& program = facts_.program;
    for (std::uint32_t i = 0; i < program.ops.size(); ++i) {
      const Op& op = program.ops[i];
      if (op.instruction->hidden != Hidden::Number || op[0].unread()) continue;
      const bool timer = op.instruction->operand[0].areas == set_of(Area::T);
      MemoryMap::Element element{op[2].at, i, {}};
      if (!op[1].pointer && !op[1].unread() && op[1].at >= image::kConstants)
        element.preset = static_cast<std::int16_t>(load16(&program.constants[op[1].at - image::kConstants]));
      (timer ? map_.timers : map_.counters).push_back(element);
    }
    std::ranges::stable_sort(map_.timers, {}, &MemoryMap::Element::number);
    std::ranges::stable_sort(map_.counters, {}, &MemoryMap::Element::number);
  }

  void add_savers() {
    const Bits request{sm::kEepromRequest * 8u, 8};
    for (const ReferenceEntry& entry : reference_.entries)
      for (const Use& use : entry.uses)
        if (use.access.writes() && use.access.bits.overlaps(request)) map_.savers.push_back(use.op);
  }

  const Facts& facts_;
  const CrossReference& reference_;
  Calls calls_;
  MemoryMap map_{};
};

}  // namespace

MemoryMap memory_map(const Facts& facts, const CrossReference& reference) { return MapBuilder(facts, reference).all(); }

}  // namespace s7200
