// The CPU: executes a Program in simulated time.
//
// Time. An instruction sees the world as of its start; what it does to the outside carries its end. run() goes on until
// the next event of the queue is due, so that nothing the outside does comes too late. Interrupts are taken in one place,
// between two instructions (take_interrupt), or at any instant of the system's own part of the scan.
//
// Not documented, modelled so:
// - The four parts of the scan that are not the program take a quarter of the scan overhead each.
//   [ScanCycle.InputsAreReadBeforeAndOutputsWrittenAfterTheProgram]
// - SM4.3 stays 1 until the next change to RUN. [Choices.SM43StaysUntilTheNextRun]
// - An interrupt routine starts with the top of the logic stack at 1, as a subroutine does.
//   [Choices.AnInterruptRoutineStartsWithTheTopOfTheStackAtOne]
// - DTCH drops what its event has queued. ATCH keeps it, and the routine attached when it is served is the one that runs.
//   [Interrupt.DtchDropsWhatItsEventHasQueuedAndNothingElse, Interrupt.TheRoutineAttachedLastServesWhatWaits]
// - A timed interrupt with an interval of 0, or below the shortest of the CPU, takes the shortest.
//   [TimedInterrupt.ShorterThan5MillisecondsAndZeroAre5]
// - Timed interrupts count whole milliseconds from the end of ATCH, not ticks of a clock of their own.
//   [TimedInterrupt.AnotherAtchBeginsAnewWithTheNewPeriod]
// - The watchdog error names the instruction during which the time ran out.
//   [Choices.TheWatchdogNamesTheInstructionDuringWhichItRanOut]
// Not modelled: expansion module errors (SM5, SMB8–21), forced values, memory cartridge, PPI on the port, an output table
// that differs from the default.
#pragma once

#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <span>

#include "interpreter/base/bytes.hpp"
#include "interpreter/base/event_queue.hpp"
#include "interpreter/cpu/serial_port.hpp"
#include "interpreter/cpu/state.hpp"
#include "interpreter/program/program.hpp"
#include "interpreter/trace/trace.hpp"

namespace s7200 {

/// Codes of run-time errors (facts 5.2) and fatal errors (5.1) that the simulated CPU can report.
enum class RunError : std::uint16_t {
  CounterNotDefined = 0x01,
  PointTaken = 0x02,
  InputTaken = 0x03,
  IndirectAddress = 0x06,
  Clock = 0x07,
  CallDepth = 0x08,
  PortBusy = 0x09,
  CounterDefinedTwice = 0x0A,
  CompareValue = 0x0F,
  OperandRange = 0x91,
  Count = 0x92,
  EepromRange = 0x94,
  FreeportInInterrupt = 0x9A,
};
enum class FatalError : std::uint16_t { Watchdog = 0x03, CompareIndirect = 0x11, CompareValue = 0x12 };

/// One line of meaning for a code, for people.
std::string_view meaning_of(RunError code);
std::string_view meaning_of(FatalError code);

/// What the CPU's own events are: timed interrupts, the millisecond of the 1 ms timers, edges of the pulse outputs.
enum CpuEvent : std::uint8_t { kTimedInterrupt0, kTimedInterrupt1, kTick1ms, kPulse0, kPulse1 };

class Cpu {
 public:
  /// Nothing is owned but the program. The CPU is in STOP until power_up().
  Cpu(std::shared_ptr<const Program> program, EventQueue& queue, SerialPort& port);

  // --- from outside ---

  /// Clears all memory but what `memory` has kept, and goes to RUN (mode switch in RUN) or stays in STOP (TERM). Without
  /// `memory` the CPU is as new.
  void power_up(bool run = true, const RetentiveMemory* memory = nullptr);

  /// What would be kept if power went off now.
  RetentiveMemory retentive_memory() const;

  /// Runs until its clock has reached `limit`, an event of the queue is due, the sink stops it, it goes to STOP, or (when
  /// asked) a scan has ended or a run-time error has occurred. Whoever calls then handles the events that are due at or
  /// before time().
  void run(Time limit);

  /// Stops run() at the end of each scan, or not.
  void pause_at_scan_end(bool on) { pause_at_scan_end_ = on; }
  /// Stops run() after each instruction that causes a run-time error, or not.
  void pause_at_error(bool on) { pause_at_error_ = on; }
  /// Why run() came back early, reset by the next run().
  bool paused() const { return paused_; }

  /// One of the CPU's own events (CpuEvent) is due.
  void handle(const Event& event);

  /// Reports of the serial port.
  void character_received(const ReceivedCharacter& character);
  void character_sent(Time at);

  /// Sets an input byte; edges of I0.0–I0.3 are events 0–7, and the high-speed counters count.
  void set_input(std::uint32_t byte, std::uint8_t value, Time at);

  /// The time of day.
  void set_clock(const ClockTime& to);
  ClockTime clock() const;

  const State& state() const { return s; }
  void restore(const State& state) { s = state; }
  const Program& program() const { return *program_; }
  Time time() const { return s.time; }

  /// Writes memory as a programming device would. `at` is a place in the image.
  void poke(std::uint32_t at, std::span<const std::uint8_t> bytes);

  void set_sink(TraceSink* sink) { sink_ = sink; }

  /// Value of operand `i` as the instruction would find it now; nothing for a bad pointer or a plain number.
  std::optional<std::uint32_t> peek(const Op& op, std::size_t i) const;

  /// Place in the image that a pointer value leads to, for an operand of `width` bytes.
  std::optional<std::uint32_t> resolve(std::uint32_t pointer, std::uint32_t width) const {
    const std::uint32_t code = pointer >> 24, offset = pointer & 0xFF'FFFF;
    if (code >= kReaches || offset + width > reach_[code].size) return {};
    return reach_[code].base + offset;
  }

  // --- for the bodies of instructions ---

  State s;

  /// A direct operand as a value: std::uint8_t, std::uint16_t, std::int16_t, std::uint32_t, std::int32_t, float.
  template <class Value>
  Value get(const Operand& operand) const;
  template <class Value>
  void put(const Operand& operand, Value value);

  bool bit(const Operand& operand) const { return (s.image[operand.at] >> operand.bit) & 1; }
  void put_bit(std::uint32_t at, std::uint8_t bit_number, bool value) {
    const auto mask = static_cast<std::uint8_t>(1u << bit_number);
    s.image[at] = static_cast<std::uint8_t>(value ? s.image[at] | mask : s.image[at] & ~mask);
  }

  /// Sets and resets SM1 bits: those of `mask` become `flags`.
  void set_flags(std::uint8_t mask, std::uint8_t flags) {
    s.image[image::kSM1] = static_cast<std::uint8_t>((s.image[image::kSM1] & ~mask) | flags);
  }

  void spend(const Op& op, std::int64_t units) { s.time += op.unit_cost * units; }
  void jump(std::uint32_t op) { s.pc = op; }

  /// Whether `count` bytes from `at` on lie in one area of this CPU.
  bool in_area(std::uint32_t at, std::uint32_t count) const;

  /// The same for `count` bits from a bit on.
  bool bits_in_area(const Operand& first, std::uint32_t count) const;
  /// R on timers or counters clears their current values too, and turns timers of 1 and 10 ms off.
  void clear_current_values(const Operand& first, std::uint32_t count);

  void run_error(RunError code);
  void fatal_error(FatalError code);
  /// A compare contact is the only instruction whose error stops the CPU: it raises both (facts 5.1).
  void compare_error(RunError code, FatalError fatal) {
    run_error(code);
    fatal_error(fatal);
  }

  void call(std::uint32_t target);
  void return_from_subroutine();
  void return_from_interrupt();
  void end_main_program();
  void stop();
  void reset_watchdog() {
    s.watchdog = s.time + program_->model->watchdog;
    attend();
  }
  void enable_interrupts(bool enabled);
  void attach(std::uint8_t event, std::uint8_t routine);
  void detach(std::uint8_t event);
  void transmit(std::uint32_t table);
  void read_clock(std::uint32_t buffer);
  void write_clock(std::uint32_t buffer);
  void define_counter(std::uint8_t number, std::uint8_t mode);
  void program_counter(std::uint8_t number);
  void program_pulses(std::uint8_t output);
  /// The program may have written AQ, which held `before`.
  void analog_outputs_written(const std::uint8_t* before);
  /// An immediate instruction writes an output point; a running pulse output keeps its own.
  void write_output_point(std::uint32_t byte, std::uint8_t bit, bool value);
  void execute_timer(std::uint32_t number, bool enabled, std::int16_t preset, bool retentive);

  /// The program may have written SMB30, which was `before`.
  void port_control_written(std::uint8_t before);

 private:
  void recall(const RetentiveMemory& memory);

  void execute_plain();
  void execute_observed();
  void system_phases();
  void finish_phase();
  void begin_scan();
  void end_scan();
  void update_clocks();

  void add_ticks(std::uint32_t timer, std::int64_t ticks);
  void turn_timers_off(std::uint32_t first, std::uint32_t count);
  void update_timers_at_scan_begin();
  void tick_1ms_timers(Time at);
  void await_tick_1ms(Time from);

  bool counter_uses(std::uint8_t event) const;
  void show_counter(std::uint8_t number);
  void count(std::uint8_t number, bool up, Time at);
  bool input_point(std::uint8_t point) const { return (s.image[image::kInputs + point / 8] >> (point % 8) & 1) != 0; }
  bool counter_started(std::uint8_t number) const;
  bool counter_in_reset(std::uint8_t number) const;
  void reset_counter(std::uint8_t number, Time at);
  void turn_counter(std::uint8_t number, bool up, Time at);
  void count_pulse(std::uint8_t number, std::uint8_t point, bool level, Time at);
  void counter_sees(std::uint8_t number, std::uint8_t point, bool level, Time at);

  void start_pulses(std::uint8_t output, const PulseTrain& train, Time at);
  static Time high_time(const PulseTrain& train);
  void begin_pulse(std::uint8_t output, Time at);
  void continue_pulses(std::uint8_t output, Time at);
  void end_pulses(std::uint8_t output);

  bool pulses_drive(std::uint32_t byte, std::uint8_t bit) const;
  void put_output_point(std::uint32_t byte, std::uint8_t bit, bool value, Time at);
  void put_output_byte(std::uint32_t byte, std::uint8_t value, Time at);
  void write_outputs();
  void clear_outputs();
  bool begin_save_to_eeprom();
  void end_save_to_eeprom();

  void enter_run();
  void enter_stop();

  bool interrupt_due() const { return s.waiting != 0 && s.interrupts_enabled && !s.in_interrupt; }
  void take_interrupt();
  void occurred(std::uint8_t event, Time at, std::uint8_t byte = 0, bool parity_error = false);
  QueuedInterrupt next_queued();
  void forget_overflow_if_idle();

  void follow_port_control(Time at);
  void take_port_control(Time at);
  void send_next_character(Time at);
  void close_port();

  /// The loop is to look around again before the next instruction.
  void attend() { until_ = 0; }

  void trace(const TraceRecord& record) const {
    if (sink_) sink_->record(record);
  }
  /// What an error is put down to: the instruction being executed; none in the system's own part of the scan.
  std::uint32_t current_op() const { return s.in_interrupt || s.phase == Phase::Program ? op_ : kNoRoutine; }

  std::shared_ptr<const Program> program_;
  const Op* ops_;  // of the program
  const Reach* reach_;
  EventQueue& queue_;
  SerialPort& port_;
  TraceSink* sink_ = nullptr;
  Time until_ = 0;        ///< the loop looks around when the clock has come to here
  std::uint32_t op_ = 0;  ///< being executed
  bool pause_at_scan_end_ = false;
  bool pause_at_error_ = false;
  bool paused_ = false;
};

template <class Value>
inline Value Cpu::get(const Operand& operand) const {
  const std::uint8_t* from = &s.image[operand.at];
  if constexpr (sizeof(Value) == 1)
    return static_cast<Value>(*from);
  else if constexpr (sizeof(Value) == 2)
    return static_cast<Value>(load16(from));
  else
    return std::bit_cast<Value>(load32(from));
}

template <class Value>
inline void Cpu::put(const Operand& operand, Value value) {
  std::uint8_t* to = &s.image[operand.at];
  if constexpr (sizeof(Value) == 1)
    *to = static_cast<std::uint8_t>(value);
  else if constexpr (sizeof(Value) == 2)
    store16(to, static_cast<std::uint16_t>(value));
  else
    store32(to, std::bit_cast<std::uint32_t>(value));
}

}  // namespace s7200
