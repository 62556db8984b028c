#include "interpreter/cpu/power.hpp"

#include <algorithm>

#include "interpreter/cpu/clock.hpp"
#include "interpreter/cpu/scan.hpp"
#include "interpreter/cpu/units.hpp"

namespace s7200::power {

void up(Core& core, bool run, const RetentiveMemory* memory, Time at) {
  core.s = State{};
  core.s.time = core.s.previous_scan_begin = at;
  const auto& constants = core.program().constants;
  std::copy(constants.begin(), constants.end(), core.s.image.begin() + image::kConstants);
  for (const Op& op : core.program().ops)
    if (op.instruction->hidden == Hidden::RisingMemory) core.put_bit(op[2].at, op[2].bit, true);
  core.s.image[sm::kIdentification] = core.model().identification;
  core.s.station = core.program().system_block.ppi_stations;
  units::power_up(core, memory);
  core.put_mask(sm::kScanStatus, sm::kModeSwitchRun, run);
  if (run) scan::enter_run(core);
  scan::begin(core);
}

RetentiveMemory retentive_memory(const Core& core) {
  RetentiveMemory memory{.eeprom = core.s.eeprom, .clock = clock::now(core), .forcing = core.s.forcing};
  for (const RetentiveRange& range : core.model().retentive)
    std::copy_n(core.s.image.begin() + range.at(), range.bytes(), memory.image.begin() + range.at());
  return memory;
}

void recall_ranges(Core& core, const RetentiveMemory* memory) {
  if (!memory) return;
  core.put_mask(sm::kScanStatus, sm::kRetentiveLost, memory->ram_lost);
  if (memory->ram_lost) return;
  for (const RetentiveRange& range : core.model().retentive)
    std::copy_n(memory->image.begin() + range.at(), range.bytes(), core.s.image.begin() + range.at());
}

}  // namespace s7200::power
