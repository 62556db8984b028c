#include "interpreter/analysis/memory_map.hpp"

#include <algorithm>
#include <utility>

#include "interpreter/analysis/memory_names.hpp"
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
  MapBuilder(const Facts& facts, const CrossReference& reference) : facts_(facts), reference_(reference) {}

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
    map_.areas.push_back({wanted, routine, bits_of_area(*facts_.program.model, wanted), {}, {}, {}, {}});
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
    for (const RetentiveRange& range : facts_.program.retentive())
      if (range.area == area.area && range.count != 0) area.retentive.push_back({range.at() * 8u, range.bytes() * 8u});
    for (std::size_t i = 0; i < reference_.pointers.size(); ++i)
      if (std::ranges::any_of(reference_.pointers[i].targets, [&](const Bits& bits) { return bits.overlaps(area.all); }))
        area.pointers.push_back(i);
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
  MemoryMap map_{};
};

}  // namespace

MemoryMap memory_map(const Facts& facts, const CrossReference& reference) { return MapBuilder(facts, reference).all(); }

}  // namespace s7200
