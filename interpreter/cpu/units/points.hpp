// The input and output points themselves, as opposed to their image registers.
//
// Not documented, modelled so:
// - What a programming device sets in STOP are the points: their image stays, and the next STOP begins with all points off.
//   An analog output keeps its value. [S7Services.OutputsAreSetInStopUntilTheNextChangeOfTheMode]
// Not modelled: an output table for STOP that differs from the default, which is all points off.
#pragma once

#include "interpreter/cpu/core.hpp"
#include "interpreter/program/operands/address.hpp"

namespace s7200::points {

/// An input byte has a new value: the units see the points that have changed.
void set_inputs(Core& core, std::uint32_t byte, std::uint8_t value, Time at);

/// Copies the input points to their image, at the start of the scan.
inline void read_inputs(Core& core) {
  std::memcpy(&core.s.image[image::kI], &core.s.image[image::kInputs], image::kPointBytes);
}

/// Writes an output point for an immediate instruction; a running pulse output keeps its point.
void write_output(Core& core, std::uint32_t byte, std::uint8_t bit, bool value);

/// Writes an output point, even one with a running pulse output.
void put_output(Core& core, std::uint32_t byte, std::uint8_t bit, bool value, Time at);

/// A programming device can set these in STOP: outputs, and words of analog outputs.
bool can_be_set_in_stop(const MemoryRange& place);
/// Sets it until the next change of the mode.
void set_in_stop(Core& core, const MemoryRange& place, std::uint32_t value);
/// The output points are as they are set and forced in STOP.
void write_stop_outputs(Core& core);

// For the table of units.
void enter_stop(Core& core);
void write_outputs(Core& core);
/// The output points follow their image.
inline void end_scan(Core& core) {
  if (std::memcmp(&core.s.image[image::kOutputs], &core.s.image[image::kQ], image::kPointBytes) != 0) write_outputs(core);
}

}  // namespace s7200::points
