// The input and output points themselves, as opposed to their image registers.
// Not modelled: an output table for STOP that differs from the default, which is all points off.
#pragma once

#include "interpreter/cpu/core.hpp"

namespace s7200::points {

/// An input byte has a new value: the units see the points that have changed.
void set_inputs(Core& core, std::uint32_t byte, std::uint8_t value, Time at);

/// At the start of the scan: copies the input points to their image.
inline void read_inputs(Core& core) {
  std::memcpy(&core.s.image[image::kI], &core.s.image[image::kInputs], image::kPointBytes);
}

/// Writes an output point for an immediate instruction; a running pulse output keeps its point.
void write_output(Core& core, std::uint32_t byte, std::uint8_t bit, bool value);

/// Writes an output point, even one with a running pulse output.
void put_output(Core& core, std::uint32_t byte, std::uint8_t bit, bool value, Time at);

// For the table of units.
void enter_stop(Core& core);
void write_outputs(Core& core);
/// The output points follow their image.
inline void end_scan(Core& core) {
  if (std::memcmp(&core.s.image[image::kOutputs], &core.s.image[image::kQ], image::kPointBytes) != 0) write_outputs(core);
}

}  // namespace s7200::points
