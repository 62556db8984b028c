// The units of the CPU: what each does by itself, and when. units.cpp has the table, a row for each.
#pragma once

#include <cstdint>

#include "interpreter/cpu/core.hpp"

namespace s7200 {

/// Events that units schedule for themselves. Those due at the same instant are handled in this order.
enum UnitEvent : std::uint8_t { kTimedInterrupt0, kTimedInterrupt1, kTick1ms, kPulse0, kPulse1 };

/// Each function goes through the rows of the table, from the first to the last.
namespace units {

/// The state is new; what `memory` has kept is taken from it. Without `memory` the CPU is as new.
void power_up(Core& core, const RetentiveMemory* memory);
void enter_run(Core& core);
void enter_stop(Core& core);
/// In RUN: the inputs have been read, and the program is about to start; the program and its outputs are done.
void begin_scan(Core& core);
void end_scan(Core& core);
/// The points of `changed` in an input byte have changed; all of them stand at their new levels.
void inputs_changed(Core& core, std::uint32_t byte, std::uint8_t changed, Time at);
/// The routine of an interrupt is about to start.
void begin_service(Core& core, const QueuedInterrupt& interrupt);
/// An event that a unit has scheduled for itself is due.
void handle(Core& core, std::uint8_t what, Time at);

}  // namespace units
}  // namespace s7200
