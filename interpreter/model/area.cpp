#include "interpreter/model/area.hpp"

#include <algorithm>

namespace s7200 {

// Pointer codes of I, Q, M and V: facts section 9, taken from real programs. That late CPUs 22x point to SM, AI and AQ, too:
// facts 1.5.
// Not documented, modelled so: pointers to S, T and C have the codes 04, 07 and 06, those to SM, AI and AQ 09, 0A and 0B. No
// program seen so far writes these as numbers; a published one for a CPU 22x takes 05 for an area that does not exist.
// [Choices.PointerCodesOfTheAreas, Pointers.ReachSpecialAndAnalogMemoryOnLateCpus]
static constexpr std::array<AreaInfo, kAreas> kAreaTable{{
    {Area::I, "I", image::kI, image::kI, 0, 0x00, "inputs (image register)"},
    {Area::Q, "Q", image::kQ, image::kQ, 0, 0x01, "outputs (image register)"},
    {Area::M, "M", image::kM, image::kM, 0, 0x02, "memory bits"},
    {Area::SM, "SM", image::kSM, image::kSM, 0, 0x09, "special memory"},
    {Area::S, "S", image::kS, image::kS, 0, 0x04, "sequence control relays"},
    {Area::AI, "AI", image::kAI, kNoBits, 0, 0x0A, "analog inputs"},
    {Area::AQ, "AQ", image::kAQ, kNoBits, 0, 0x0B, "analog outputs"},
    {Area::T, "T", image::kT, image::kTBits, 2, 0x07, "timers"},
    {Area::C, "C", image::kC, image::kCBits, 2, 0x06, "counters"},
    {Area::HC, "HC", image::kHC, kNoBits, 4, {}, "high-speed counters"},
    {Area::AC, "AC", image::kAC, kNoBits, 4, {}, "accumulators"},
    {Area::V, "V", image::kV, image::kV, 0, 0x08, "variable memory"},
    {Area::L, "L", image::kL, image::kL, 0, {}, "local memory of a routine"},
}};

const std::array<AreaInfo, kAreas>& all_areas() { return kAreaTable; }

const AreaInfo& area_at(std::uint32_t place) {
  const AreaInfo* area = kAreaTable.data();
  for (const AreaInfo& each : kAreaTable)
    if (place >= each.base && each.base > area->base) area = &each;
  return *area;
}

const AreaInfo& info(Area area) { return kAreaTable[static_cast<std::size_t>(area)]; }

std::optional<Area> area_named(std::string_view name) {
  const auto found = std::find_if(kAreaTable.begin(), kAreaTable.end(), [&](const AreaInfo& a) { return a.name == name; });
  if (found == kAreaTable.end()) return {};
  return found->area;
}

}  // namespace s7200
