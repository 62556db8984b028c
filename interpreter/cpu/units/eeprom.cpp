#include "interpreter/cpu/units/eeprom.hpp"

#include <algorithm>

namespace s7200::eeprom {

static std::uint32_t bytes_to_save(std::uint8_t request) {
  const int size = request & sm::kSaveSize;
  return size == 3 ? 4 : size == 2 ? 2 : 1;
}

void end_save(Core& core) { core.put_mask(sm::kEepromRequest, sm::kSave, false); }

/// Into V memory, and into the EEPROM as far as that can hold it.
static void download_data(Core& core) {
  const std::uint32_t permanent = core.model().eeprom_bytes;
  for (const InitialData& data : core.program().data) {
    std::ranges::copy(data.bytes, core.s.image.begin() + image::kV + data.offset);
    if (data.offset >= permanent) continue;
    const std::size_t kept = std::min<std::size_t>(data.bytes.size(), permanent - data.offset);
    std::copy_n(data.bytes.begin(), kept, core.s.eeprom.begin() + data.offset);
  }
}

void power_up(Core& core, const RetentiveMemory* memory) {
  if (!memory) return download_data(core);
  core.s.eeprom = memory->eeprom;
  std::copy_n(core.s.eeprom.begin(), core.model().eeprom_bytes, core.s.image.begin() + image::kV);
}

void begin_save(Core& core) {
  State& s = core.s;
  const std::uint32_t bytes = bytes_to_save(s.image[sm::kEepromRequest]);
  const std::uint32_t offset = load16(&s.image[sm::kEepromAddress]);
  if (offset + bytes > core.model().eeprom_bytes) {
    end_save(core);
    return core.run_error(RunError::EepromRange);
  }
  std::copy_n(s.image.begin() + image::kV + offset, bytes, s.eeprom.begin() + offset);
  s.phase = Phase::SaveToEeprom;
  s.phase_left = core.program().eeprom_save;
}

}  // namespace s7200::eeprom
