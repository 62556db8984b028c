#include "interpreter/cpu/units/power.hpp"

#include <algorithm>

#include "interpreter/cpu/scan.hpp"
#include "interpreter/cpu/units.hpp"
#include "interpreter/cpu/units/clock.hpp"

namespace s7200::power {

void up(Core& core, bool run, const RetentiveMemory* memory, Time at) {
  core.s = State{};
  core.s.time = core.s.previous_scan_begin = at;
  const auto& constants = core.program().constants;
  std::copy(constants.begin(), constants.end(), core.s.image.begin() + image::kConstants);
  for (const Op& op : core.program().ops)
    if (op.instruction->hidden == Hidden::RisingMemory) core.put_bit(op[2].at, op[2].bit, true);
  core.s.image[sm::kIdentification] = core.model().identification;
  for (const std::uint32_t module : sm::kModuleIdentity) core.s.image[module] = sm::kNoModule;
  core.s.station = core.program().system_block.ppi_stations;
  units::power_up(core, memory);
  core.put_mask(sm::kScanStatus, sm::kModeSwitchRun, run);
  if (run) scan::enter_run(core);
  scan::begin(core);
}

/// The part of a retentive range that is saved to EEPROM when power goes off: MB0 to MB13 (facts 1.6).
static RetentiveRange saved_at_power_off(const RetentiveRange& range) {
  constexpr std::uint32_t kSavedBytes = 14;
  const bool saved = range.area == Area::M && range.first < kSavedBytes;
  return {range.area, range.first, saved ? std::min(range.count, kSavedBytes - range.first) : 0};
}

RetentiveMemory retentive_memory(const Core& core) {
  RetentiveMemory memory{.eeprom = core.s.eeprom,
                         .clock = clock::now(core),
                         .clock_fraction = clock::fraction(core),
                         .forcing = core.s.forcing};
  for (const RetentiveRange& range : core.program().retentive())
    std::copy_n(core.s.image.begin() + range.at(), range.bytes(), memory.image.begin() + range.at());
  return memory;
}

void recall_ranges(Core& core, const RetentiveMemory* memory) {
  if (!memory) return;
  core.put_mask(sm::kScanStatus, sm::kRetentiveLost, memory->ram_lost);
  for (const RetentiveRange& each : core.program().retentive()) {
    const RetentiveRange range = memory->ram_lost ? saved_at_power_off(each) : each;
    std::copy_n(memory->image.begin() + range.at(), range.bytes(), core.s.image.begin() + range.at());
  }
}

}  // namespace s7200::power
