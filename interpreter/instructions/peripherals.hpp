// Bodies: clock, interval time, port addresses, points at once, high-speed counters, pulse outputs (facts 6.5, 6.11, 6.12,
// 10.7). Most of the work is in cpu/.
//
// Not documented, modelled so:
// - The interval time starts at 0 at power-up. [IntervalTime.CountsMillisecondsFromPowerUp]
// - BIR through a pointer to anything but inputs, and BIW through one to anything but outputs, is range error 0091.
//   [Vectors.BIR, Vectors.BIW]
// - A station address lasts until the next power-up, any byte will do, and it is 2 at first.
//   [PortAddress.SpaSetsWhatGpaReads, PortAddress.IsTwoAfterPowerUp]
#pragma once

#include "interpreter/cpu/core.hpp"
#include "interpreter/cpu/units/clock.hpp"
#include "interpreter/cpu/units/high_speed_counters.hpp"
#include "interpreter/cpu/units/points.hpp"
#include "interpreter/cpu/units/pulse_outputs.hpp"

namespace s7200::bodies {

inline void read_clock(Core& core, const Op& op) { clock::read(core, op[0].at); }
inline void write_clock(Core& core, const Op& op) { clock::write(core, op[0].at); }

/// BITIM: the milliseconds since power-up, modulo 2^32; CITIM: how many have passed since IN.
inline std::uint32_t milliseconds(const Core& core) {
  return static_cast<std::uint32_t>(core.s.time / core.by_own_clock(kMillisecond));
}
inline void begin_interval(Core& core, const Op& op) { core.put(op[0], milliseconds(core)); }
inline void read_interval(Core& core, const Op& op) { core.put(op[1], milliseconds(core) - core.get<std::uint32_t>(op[0])); }

/// GPA ADDR, PORT and SPA ADDR, PORT: the station address, which Freeport mode does not use.
inline void get_port_address(Core& core, const Op& op) { core.put(op[0], core.s.station[op[1].at]); }
inline void set_port_address(Core& core, const Op& op) {
  if (core.s.in_interrupt) return core.run_error(RunError::NotInInterrupt);
  core.s.station[op[1].at] = core.get<std::uint8_t>(op[0]);
}

inline void switch_diagnostic_led(Core& core, const Op& op) { core.s.diagnostic_led = core.get<std::uint8_t>(op[0]) != 0; }

/// The input or output points of an image byte; reports a range error and returns nothing if it is not one.
inline std::optional<std::uint32_t> points_of(Core& core, std::uint32_t at, Area area) {
  const std::uint32_t first = info(area).base;
  if (at >= first && at < first + image::kPointBytes) return at - first;
  core.run_error(RunError::OperandRange);
  return {};
}

/// BIR: reads eight input points; their image stays as it is.
inline void read_points(Core& core, const Op& op) {
  if (const auto byte = points_of(core, op[0].at, Area::I)) core.put(op[1], core.s.image[image::kInputs + *byte]);
}

/// BIW: writes eight output points and their image.
inline void write_points(Core& core, const Op& op) {
  const auto byte = points_of(core, op[1].at, Area::Q);
  if (!byte) return;
  const auto value = core.get<std::uint8_t>(op[0]);
  core.put(op[1], value);
  for (std::uint8_t bit = 0; bit < 8; ++bit) points::write_output(core, *byte, bit, value >> bit & 1);
}

inline void define_counter(Core& core, const Op& op) {
  high_speed_counters::define(core, static_cast<std::uint8_t>(op[0].at), static_cast<std::uint8_t>(op[1].at));
}
inline void program_counter(Core& core, const Op& op) {
  high_speed_counters::program(core, static_cast<std::uint8_t>(op[0].at));
}
inline void program_pulses(Core& core, const Op& op) { pulse_outputs::program(core, static_cast<std::uint8_t>(op[0].at)); }

}  // namespace s7200::bodies
