// The CPU: executes a Program in simulated time.
//
// Time. An instruction sees the world as it was at its start; what it does to the outside happens at its end. run() goes on
// until the next event of the queue is due, so nothing from the outside arrives too late. Interrupts are taken in one place:
// between two instructions (run), or at any instant of the system's own part of the scan.
//
// Not documented, modelled so: the watchdog error names the instruction during which the time ran out.
// [Choices.TheWatchdogNamesTheInstructionDuringWhichItRanOut]
// Not modelled: expansion modules and their errors (SMB5 stays 0, SMB8–21 are refused), memory cartridge.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "interpreter/cpu/core.hpp"
#include "interpreter/cpu/steady_scans.hpp"
#include "interpreter/program/operands/address.hpp"

namespace s7200 {

class Cpu {
 public:
  /// `owner` is the CPU's number in the queue, and `ports` has as many as the program's CPU. A CPU owns nothing but the
  /// program. It is in STOP until power_up().
  Cpu(std::shared_ptr<const Program> program, EventQueue& queue, EventOwner owner, const Ports& ports);

  /// Clears all memory except what `memory` has kept, and goes to RUN (mode switch in RUN) or stays in STOP (TERM). Without
  /// `memory` the CPU is brand-new. Its clock stands at `at` then.
  void power_up(bool run = true, const RetentiveMemory* memory = nullptr, Time at = 0);

  /// The memory that would be kept if power went off now.
  RetentiveMemory retentive_memory() const;

  /// Runs until its clock reaches `limit`, an event of the queue is due, the sink stops it, the mode changes, or (on
  /// request) a scan has ended or a run-time error has occurred. The caller then handles the events that are due at or
  /// before time(). Also returns after `work` of simulated time, in which scans that were passed over do not count.
  void run(Time limit, Time work = kNever);

  /// Whether scans that are all alike are passed over (steady_scans.hpp). What is computed does not depend on it.
  void use_steady_scans(SteadyScansUse use) { steady_scans_.use(use); }
  /// Simulated time in scans that were passed over so far.
  Time passed_over() const { return steady_scans_.passed_over(); }
  /// The number of times that the CPU has looked whether scans can be passed over; each costs about as much as a thousand
  /// instructions.
  std::uint64_t looks_at_scans() const { return steady_scans_.looks(); }
  /// The instant until which the CPU does nothing but the same scan again, unless something comes from outside; time() if
  /// that is not known. Until then it sends nothing.
  Time alike_until() const { return steady_scans_.alike_until(core_); }
  /// The same, after a look at what has come from outside since it ran last.
  Time look_ahead();

  /// Whether run() stops at the end of each scan.
  void pause_at_scan_end(bool on) { core_.loop.pause_at_scan_end = on; }
  /// Whether run() stops after each instruction that causes a run-time error.
  void pause_at_error(bool on) { core_.loop.pause_at_error = on; }
  /// Whether run() stopped early for one of these reasons or for the sink; the next run() resets it.
  bool paused() const { return core_.loop.paused; }

  /// Handles one of the CPU's own events, which is due.
  void handle(const Event& event);

  /// Reports of a serial port.
  void character_received(const ReceivedCharacter& character, std::uint8_t port = 0);
  void character_sent(Time at, std::uint8_t port = 0);

  /// Tells the trace of a character that the line brings while the receiver is off, or the PLC has no power. Nothing comes
  /// of it, and without a sink nobody need say so.
  void character_missed(const ReceivedCharacter& character, std::uint8_t port, bool powered) const;
  bool traced() const { return core_.sink() != nullptr; }

  /// Sets an input byte; edges of I0.0–I0.3 are events 0–7, and the high-speed counters count.
  void set_input(std::uint32_t byte, std::uint8_t value, Time at);

  /// Sets how far its crystal is off, in millionths; positive: it is too fast. This comes before it is powered up.
  void set_clock_error(std::int32_t millionths) { core_.set_clock_error(millionths); }

  /// The time of day.
  void set_clock(const ClockTime& to);
  ClockTime clock() const;

  const State& state() const { return core_.s; }
  void restore(const State& state) { from_outside().s = state; }
  const Program& program() const { return core_.program(); }
  Time time() const { return core_.s.time; }

  /// The instant at which the CPU does something by itself: now, or at the end of the system's part of the scan that it is
  /// in. An event may make it act before.
  Time next_action() const;

  /// Writes memory as a programming device would. `at` is a place in the image.
  void poke(std::uint32_t at, std::span<const std::uint8_t> bytes);

  /// Forces points or a value of memory as a programming device does (forcing.hpp says which can be); false if sixteen
  /// values of memory are forced already.
  bool force(const MemoryRange& place, std::uint32_t value);
  /// Takes back what is forced there; whether there was anything.
  bool unforce(const MemoryRange& place);

  /// The levels that are wired to an input byte, whatever is forced.
  std::uint8_t terminals(std::uint32_t byte) const { return core_.s.terminals[byte]; }

  void set_sink(TraceSink* sink) { from_outside().set_sink(sink); }

  /// Sets who is wired to the output points; null: nobody. A listener is not owned.
  void set_output_listener(OutputListener* listener) { core_.set_output_listener(listener); }

  /// The value of operand `i` as the instruction would find it now; nothing for a bad pointer.
  std::optional<std::uint32_t> peek(const Op& op, std::size_t i) const;
  /// The same of memory that a CALL hands over.
  std::optional<std::uint32_t> peek(const Operand& operand, Width width) const;

  /// The place in the image that an operand means now; nothing for a bad pointer.
  std::optional<std::uint32_t> place_of(const Operand& operand) const {
    if (!operand.pointer) return operand.at;
    return core_.resolve(load32(&core_.s.image[operand.at]), operand.width);
  }

  /// Goes on with another instruction, of the same routine. Nothing but a debugger can do that.
  void go_to(std::uint32_t op) { from_outside().s.pc = op; }

  /// The logic stack, with the power flow, is another one. Nothing but a debugger can do that.
  void set_stack(LogicStack stack) { from_outside().s.stack = stack; }

  /// The core is for making one unit act on its own, as tests do.
  Core& core() { return core_; }

 private:
  /// Everything that is done to the CPU goes through this: after it, scans need no longer be alike (steady_scans.hpp).
  Core& from_outside();

  void execute_plain();
  void execute_observed(TraceSink& sink);
  template <Watch watch>
  void execute_watched(TraceSink& sink);
  void look_at(const Op& op, std::uint8_t operands, InstructionRecord& record) const;

  Core core_;
  SteadyScans steady_scans_;
};

}  // namespace s7200
