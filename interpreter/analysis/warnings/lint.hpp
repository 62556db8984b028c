// Warnings that need the whole program. If it has errors, what they are in is unread (program/loading/unread.hpp). Each
// function finds one warning of warnings.hpp.
//
// A wrong warning is worse than none. So two coils, or two executions of a timer, are reported only if no pass through the
// program does one without the other; not if JMP, CRET, END, FOR or a conditional CALL may leave one out.
#pragma once

#include <cstdint>
#include <optional>

#include "interpreter/analysis/effects/facts.hpp"
#include "interpreter/analysis/waiter.hpp"
#include "interpreter/base/diagnostic.hpp"

namespace s7200 {

/// A coil that always overwrites what an earlier one has written. An inactive segment writes its coils too, so LSCR does not
/// keep them apart. Memory may have two coils if it is read in between; an output may not, because the last coil decides:
/// that of the scan, too, if the other one is an interrupt's.
void find_double_coils(const Facts& facts, stl::Diagnostics& diagnostics);

/// A bit that S, R or a coil writes and that an instruction which is always executed later in the routine writes again,
/// alone or with the rest of its byte or word, before anything uses it. Two coils are find_double_coils'.
void find_overwritten(const Facts& facts, stl::Diagnostics& diagnostics);

/// An instruction after a JMP, END or CRET with sure power flow that no label lets in. The first of each stretch.
void find_unreachable(const Facts& facts, stl::Diagnostics& diagnostics);

/// EU and ED have one memory bit each: executed twice in a scan, the second time sees no edge.
void find_repeated_edges(const Facts& facts, stl::Diagnostics& diagnostics);

/// 100 ms timers count when they are executed, and have to be once in each scan (facts 6.4): one that a jump leaves out, in
/// a subroutine that is only called under a condition, or in a FOR loop.
void find_skipped_timers(const Facts& facts, stl::Diagnostics& diagnostics);

/// SM0.0 is always 1. LDN SM0.0 is left alone: it is how programs write a constant 0, or switch a rung off.
void find_constant_contacts(const Facts& facts, stl::Diagnostics& diagnostics);

/// A comparison that holds for all numbers of its width or for none: VB0 >= 0, VW0 > 32767, 5 >= 3.
void find_constant_comparisons(const Facts& facts, stl::Diagnostics& diagnostics);

/// A rung that needs what excludes each other, VW2 >= 950 and VW2 <= 90: power flow that no memory gives.
void find_never_true(const Facts& facts, stl::Diagnostics& diagnostics);

/// A counter that a comparison with its own value resets below its preset, and whose bit a contact looks at.
void find_unreached_presets(const Facts& facts, stl::Diagnostics& diagnostics);

/// ATCH of a timed interrupt that surely is executed in every scan: it starts the period again each time (facts 3.4).
void find_restarted_timers(const Facts& facts, stl::Diagnostics& diagnostics);

/// A timer or counter has one current value: executed twice in a scan, it counts twice or is reset by the other rung.
void find_double_timers(const Facts& facts, stl::Diagnostics& diagnostics);
void find_double_counters(const Facts& facts, stl::Diagnostics& diagnostics);

/// A PID keeps what it needs from one execution to the next by the number of its loop.
void find_double_loops(const Facts& facts, stl::Diagnostics& diagnostics);

/// A timed interrupt that takes longer than its period leaves no time for the main program, and is lost now and then. By the
/// longest way through its routine (bounds.hpp). If `waiter` asks to end, there is none.
void find_long_interrupts(const Facts& facts, stl::Diagnostics& diagnostics, const Waiter& waiter = {});

/// Interrupts are disabled when the CPU enters RUN (facts 3.3).
void find_missing_eni(const Facts& facts, stl::Diagnostics& diagnostics);

/// SMB30 is 0 when the CPU enters RUN: the port speaks PPI.
void find_missing_freeport(const Facts& facts, stl::Diagnostics& diagnostics);

/// SMB2 and SM3.0 are written just before the routine of event 8 or 25 starts, and by nothing else (facts 2.3).
void find_missing_receive_event(const Facts& facts, stl::Diagnostics& diagnostics);

/// In Freeport mode the CPU answers nothing by itself: a port that no RCV, no XMT and no routine of event 8 or 25 uses is
/// dead. It is left out where another warning names what is missing: it comes after find_missing_freeport() and
/// find_missing_receive_event().
void find_unused_freeport(const Facts& facts, stl::Diagnostics& diagnostics);

/// RCV receives one message each time it is executed.
void find_receive_once(const Facts& facts, stl::Diagnostics& diagnostics);

/// XMT and RCV of a port exclude each other: error 0009 or 000B (facts 2.4). Only what is certain: in one pass, or while an
/// RCV waits that is always started again.
void find_busy_port(const Facts& facts, stl::Diagnostics& diagnostics);

/// Whether a port answers in PPI mode, at the station of the system block, all the time: no instruction may put it in
/// another mode or, with SPA, at another station.
bool keeps_ppi_station(const Program& program, std::uint8_t port);

/// The station that the program's SPA give a port that answers in PPI mode all the time; nothing if there is none, or not
/// one.
std::optional<std::uint8_t> ppi_station_set(const Program& program, std::uint8_t port);

/// Whether it has a NETR or NETW for a port: the port is, or becomes, a PPI master.
bool is_ppi_master(const Program& program, std::uint8_t port);

/// Bits set by S, = or SCRT. An instruction that reads S memory by bytes, words or pointers counts as loading all of it.
void find_unused_steps(const Facts& facts, stl::Diagnostics& diagnostics);

}  // namespace s7200
