// The EEPROM, which keeps V memory without power.
//
// SM31.7 asks for one V value to be saved: SM31.1–0 is its size, SMW32 its offset. It is saved at the end of the scan, which
// becomes longer by that time; then the bit is reset (S7-200 manual C230-02, 7-16).
//
// A CPU without kept memory has just been loaded: the data block of its program is in V memory and in the EEPROM.
//
// Not documented, modelled so:
// - Of the data block the EEPROM keeps what lies in the part of V that it can hold; the rest is in V memory until power is
//   lost. [DataBlock.TheEepromKeepsWhatLiesInItsPartOfV]
// - A save takes 17.5 ms, the middle of the 15 to 20 ms that the manual calls typical; `s7200 times` lists it.
//   [Eeprom.ASaveProlongsItsScanByTheTimeInTheTable]
// - Interrupts are served during a save; it saves the value that V has at its start.
//   [Eeprom.InterruptsAreServedDuringASaveOfTheValueAtItsStart]
// - A value outside the part of V that the EEPROM can hold is error 0094, and the scan does not take longer.
//   [Eeprom.TheLastAddressIsV1023AndBeyondItIs0094, Eeprom.ARefusedSaveTakesNoTime]
#pragma once

#include "interpreter/cpu/core.hpp"

namespace s7200::eeprom {

/// The time of a save has passed.
void end_save(Core& core);

// For the table of units.
void power_up(Core& core, const RetentiveMemory* memory);
void begin_save(Core& core);
/// A requested save adds a phase to the scan.
inline void end_scan(Core& core) {
  if (core.s.image[sm::kEepromRequest] & sm::kSave) begin_save(core);
}

}  // namespace s7200::eeprom
