// What the bodies of instructions and the units of the CPU work on: the state, the program, and the ways to the outside.
//
// An instruction sees the world as it was at its start. The clock is already at its end, so what it does to the outside
// happens at its end.
//
// Not documented, modelled so: how far the clock of a real CPU is off; it is exact unless a clock error is set. With one,
// all that the CPU counts by its clock is off: timers, timed interrupts, the times of RCV and NETR, the watchdog, clock bits
// and time of day. Instructions take their nominal times, and the system's part of the next scan makes up for the
// difference. The bits of its ports and the pulses of PTO and PWM stay nominal. [ClockError.AllThatCountsMillisecondsIsOff,
// ClockError.ScansAreOffAsAWhole]
// Not documented, modelled so: SM4.3 stays 1 until the next change to RUN. [Choices.SM43StaysUntilTheNextRun]
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>

#include "interpreter/base/bytes.hpp"
#include "interpreter/base/event_queue.hpp"
#include "interpreter/base/serial_port.hpp"
#include "interpreter/cpu/state.hpp"
#include "interpreter/model/errors.hpp"
#include "interpreter/model/ports.hpp"
#include "interpreter/program/program.hpp"
#include "interpreter/trace/trace.hpp"

namespace s7200 {

/// The loops of the CPU and the rest of it tell each other this.
struct Loop {
  Time until = 0;        ///< the loop looks for other work when the clock gets here
  std::uint32_t op = 0;  ///< the one being executed
  bool pause_at_scan_end = false;
  bool pause_at_error = false;
  bool paused = false;
};

/// The devices on the ports of a CPU, by number; null for those that it does not have.
using Ports = std::array<SerialPort*, kPorts.size()>;

/// A listener is wired to the output points of a CPU.
class OutputListener {
 public:
  /// The points of `byte` that `changed` has a 1 for are different from `at` on; `points` is what all of them are then.
  virtual void outputs_changed(std::uint32_t byte, std::uint8_t points, std::uint8_t changed, Time at) = 0;

 protected:
  ~OutputListener() = default;
};

class Core {
 public:
  /// Owns nothing but the program.
  Core(std::shared_ptr<const Program> program, EventQueue& queue, EventOwner owner, const Ports& ports)
      : program_(std::move(program)),
        reach_(program_->reach.data()),
        contacts_(program_->contacts.data()),
        queue_(queue),
        owner_(owner),
        port_(ports) {
    assert(std::all_of(port_.begin(), port_.begin() + port_count(), [](const SerialPort* port) { return port != nullptr; }));
  }

  State s;
  Loop loop;
  /// Set by whatever is done to the CPU from outside, and by whatever it does to the outside; cleared by who watches for it.
  mutable bool touched = false;

  const Program& program() const { return *program_; }
  const CpuModel& model() const { return *program_->model; }
  const Contact* contacts() const { return contacts_; }

  // --- operands ---

  /// A direct operand as a value: std::uint8_t, std::uint16_t, std::int16_t, std::uint32_t, std::int32_t, float.
  template <class Value>
  Value get(const Operand& operand) const;
  template <class Value>
  void put(const Operand& operand, Value value);

  bool bit(const Operand& operand) const { return (s.image[operand.at] >> operand.bit) & 1; }
  void put_bit(std::uint32_t at, std::uint8_t bit_number, bool value) {
    put_mask(at, static_cast<std::uint8_t>(1u << bit_number), value);
  }
  /// Sets or resets the bits of `mask` in a byte.
  void put_mask(std::uint32_t at, std::uint8_t mask, bool value) {
    s.image[at] = static_cast<std::uint8_t>(value ? s.image[at] | mask : s.image[at] & ~mask);
  }

  /// Sets and resets bits of SM1: those of `mask` become as in `flags`.
  void set_flags(std::uint8_t mask, std::uint8_t flags) {
    s.image[sm::kFlags] = static_cast<std::uint8_t>((s.image[sm::kFlags] & ~mask) | flags);
  }

  /// The place in the image that a pointer points to, for an operand of `width` bytes; nothing for a bad pointer.
  std::optional<std::uint32_t> resolve(std::uint32_t pointer, std::uint32_t width) const {
    const std::uint32_t code = pointer >> 24, offset = pointer & 0xFF'FFFF;
    if (code >= kReaches || offset + width > reach_[code].size) return {};
    return reach_[code].base + offset;
  }

  /// Whether an operand that a pointer has led to may be used so. SMB0 to SMB29 are read-only; analog values are words at
  /// even addresses, AI is only read and AQ only written (facts 1.1).
  static bool may_be_reached(std::uint32_t at, std::uint32_t width, Role role);
  /// The areas from SM to AQ: a pointer leads there only on late CPUs 22x, except to S.
  static bool is_beyond_memory(std::uint32_t at) { return at - image::kSM < image::kT - image::kSM; }

  /// Whether `count` bytes from `at` are in one area of this CPU.
  bool in_area(std::uint32_t at, std::uint32_t count) const;

  // --- flow of the program ---

  void spend(const Op& op, std::int64_t units) { s.time += op.unit_cost * units; }
  void jump(std::uint32_t op) { s.pc = op; }

  /// Records a run-time error of the instruction being executed and sets SM4.3 (facts 5.2); the program goes on.
  void run_error(RunError code);
  /// Goes to STOP (facts 5.1).
  void fatal_error(FatalError code);
  /// A compare contact is the only instruction whose errors stop the CPU: it raises both (facts 5.1).
  void compare_error(RunError code, FatalError fatal) {
    run_error(code);
    fatal_error(fatal);
  }
  /// The instruction to which an error belongs: the one being executed, or none in the system's own part of the scan.
  std::uint32_t current_op() const { return s.in_interrupt || s.phase == Phase::Program ? loop.op : kNoRoutine; }

  /// Makes the loop look for other work before the next instruction.
  void attend() { loop.until = 0; }

  // --- its clock ---

  /// Sets how far the crystal is off, in millionths; positive: it is too fast. It belongs to this piece of hardware, so it
  /// is no state.
  void set_clock_error(std::int32_t millionths) { clock_error_ = millionths; }
  /// The time that the CPU's clock takes for what an exact clock does in `nominal`.
  Time by_own_clock(Time nominal) const {
    return clock_error_ == 0 ? nominal : nominal - nominal * clock_error_ / 1'000'000;
  }

  // --- the outside ---

  /// Wakes the unit that `what` belongs to (UnitEvent). Each is pending at most once.
  void schedule(Time at, std::uint8_t what) {
    touched = true;
    queue_.schedule(at, owner_, what);
  }
  void cancel(std::uint8_t what) {
    touched = true;
    queue_.cancel(owner_, what);
  }
  Time next_event() const { return queue_.next(); }

  std::uint8_t port_count() const { return static_cast<std::uint8_t>(model().ports); }
  SerialPort& port(std::size_t number) {
    touched = true;
    return *port_[number];
  }

  void set_output_listener(OutputListener* listener) { output_listener_ = listener; }
  void tell_of_outputs(std::uint32_t byte, std::uint8_t before, Time at) const {
    const std::uint8_t points = s.image[image::kOutputs + byte];
    trace({.at = at, .kind = TraceKind::OutputChanged, .byte = points, .op = byte});
    if (output_listener_) output_listener_->outputs_changed(byte, points, static_cast<std::uint8_t>(points ^ before), at);
  }

  void set_sink(TraceSink* sink) { sink_ = sink; }
  TraceSink* sink() const { return sink_; }
  void trace(const TraceRecord& record) const {
    touched |= record.kind != TraceKind::ScanBegin;
    if (sink_) sink_->record(record);
  }

 private:
  std::shared_ptr<const Program> program_;
  const Reach* reach_;       // of the program
  const Contact* contacts_;  // of the program
  EventQueue& queue_;
  EventOwner owner_;
  Ports port_;
  TraceSink* sink_ = nullptr;
  OutputListener* output_listener_ = nullptr;
  std::int32_t clock_error_ = 0;
};

/// A bit, or a value of a width, as memory has it there.
inline std::uint32_t load_value(const std::uint8_t* from, Width width, std::uint8_t bit) {
  switch (width) {
    case Width::Bit:
      return *from >> bit & 1;
    case Width::Byte:
      return *from;
    case Width::Word:
      return load16(from);
    case Width::Double:
      break;
  }
  return load32(from);
}

template <class Value>
inline Value Core::get(const Operand& operand) const {
  const std::uint8_t* from = &s.image[operand.at];
  if constexpr (sizeof(Value) == 1)
    return static_cast<Value>(*from);
  else if constexpr (sizeof(Value) == 2)
    return static_cast<Value>(load16(from));
  else
    return std::bit_cast<Value>(load32(from));
}

template <class Value>
inline void Core::put(const Operand& operand, Value value) {
  std::uint8_t* to = &s.image[operand.at];
  if constexpr (sizeof(Value) == 1)
    *to = static_cast<std::uint8_t>(value);
  else if constexpr (sizeof(Value) == 2)
    store16(to, static_cast<std::uint16_t>(value));
  else
    store32(to, std::bit_cast<std::uint32_t>(value));
}

}  // namespace s7200
