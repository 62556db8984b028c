// Where steps end, forwards and backwards: goals for the stepper. `now` is where the step begins.
#pragma once

#include "tools/session/stops/stepper.hpp"
#include "tools/views/program/listing.hpp"

namespace s7200::tools::goal {

/// No place at all: a run until there is something to stop for.
Stepper::Goal none();

Stepper::Goal instructions(std::uint64_t count);

/// The next instruction of the same routine; what it calls, and interrupts in between, belong to it.
Stepper::Goal over(const State& now);

/// Whether it is in a subroutine or an interrupt routine, and can go out of it.
bool is_in_routine(const State& now);
Stepper::Goal out(const State& now);

/// The start of the program in the scan that comes after `count - 1` others.
Stepper::Goal scan(const State& now, std::uint64_t count);

Stepper::Goal place(std::uint32_t op);

/// The first instruction of another network, or of the same one again: of the same routine and its callers, or of what it
/// calls too. The listing has to live as long as the goal.
Stepper::Goal network_over(const State& now, const Listing& listing);
Stepper::Goal network_into(const Listing& listing);

/// The first instruction of the next interrupt routine, or the first one after the next that ends. The program has to live
/// as long as the goal.
Stepper::Goal interrupt_begins(const Program& program);
Stepper::Goal interrupt_ends(const State& now);

// Backwards; each may be met several times.

Stepper::Goal back_instruction();
Stepper::Goal back_over(const State& now);

/// To the CALL of the subroutine, or to what the interrupt routine interrupted.
Stepper::Goal back_out(const State& now);

/// To starts of the scan's program.
Stepper::Goal back_scan();

/// To first instructions of networks, as network_over() and network_into().
Stepper::Goal back_network_over(const State& now, const Listing& listing);
Stepper::Goal back_network_into(const Listing& listing);

/// To first instructions of interrupt routines, or to those that ended them.
Stepper::Goal back_interrupt_begins(const Program& program);
Stepper::Goal back_interrupt_ends(const Program& program);

}  // namespace s7200::tools::goal
