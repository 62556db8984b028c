// The units of the CPU: what each does on its own, and when. units.cpp has the table, one row for each unit.
#pragma once

#include <cstdint>

#include "interpreter/cpu/core.hpp"

namespace s7200 {

/// Events that units schedule for themselves. At the same instant they are handled in this order.
enum UnitEvent : std::uint8_t {
  kTimedInterrupt0,
  kTimedInterrupt1,
  kTick1ms,
  kPulse0,
  kPulse1,
  kMessageTimer0,  // one for each port, and so the next
  kNetworkTimer0 = kMessageTimer0 + kPorts.size()
};

/// Each function goes through the rows of the table, from first to last.
namespace units {

/// The state has been cleared; units take from `memory` what it has kept. Without `memory` the CPU is brand-new.
void power_up(Core& core, const RetentiveMemory* memory);
void enter_run(Core& core);
void enter_stop(Core& core);
/// Tells the units in RUN that the inputs have been read and the program is about to start.
void begin_scan(Core& core);
/// Tells the units in RUN that the program has ended and the time for writing its outputs has passed.
void end_scan(Core& core);
/// The points of `changed` in an input byte have changed; all points already have their new levels.
void inputs_changed(Core& core, std::uint32_t byte, std::uint8_t changed, Time at);
/// The routine of an interrupt is about to start.
void begin_service(Core& core, const QueuedInterrupt& interrupt);
/// An event that a unit has scheduled for itself is due.
void handle(Core& core, std::uint8_t what, Time at);

}  // namespace units
}  // namespace s7200
