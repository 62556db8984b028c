#include "tools/session/past/digest.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <string_view>
#include <tuple>
#include <type_traits>

#include "interpreter/stl/printer.hpp"

namespace s7200::tools {
namespace {

// The members of each part of a state. A structured binding has to name them all: one that is added there is missed here by
// the compiler.

auto members(const LogicStack& stack) { return std::tuple(stack.bits()); }

auto members(const CallFrame& part) {
  const auto& [return_to, stack, rail] = part;
  return std::tie(return_to, stack, rail);
}

auto members(const QueuedInterrupt& part) {
  const auto& [at, event, byte, parity_error] = part;
  return std::tie(at, event, byte, parity_error);
}

auto members(const InterruptQueue& part) {
  const auto& [entry, count] = part;
  return std::tie(entry, count);
}

auto members(const SavedContext& part) {
  const auto& [return_to, stack, rail, eno, accumulators, smb1, call_depth] = part;
  return std::tie(return_to, stack, rail, eno, accumulators, smb1, call_depth);
}

auto members(const SerialFormat& part) {
  const auto& [baud, data_bits, parity, stop_bits] = part;
  return std::tie(baud, data_bits, parity, stop_bits);
}

auto members(const MessageReceiver& part) {
  const auto& [phase, was_idle, had_break, control, start, end, most, idle_time, timeout, table, stored] = part;
  return std::tie(phase, was_idle, had_break, control, start, end, most, idle_time, timeout, table, stored);
}

auto members(const Freeport& part) {
  const auto& [control, active, transmitting, sending_break, on_line, on_wire, buffer, left, format, message] = part;
  return std::tie(control, active, transmitting, sending_break, on_line, on_wire, buffer, left, format, message);
}

auto members(const PpiPort& part) {
  const auto& [frame, received, sending, sent, lost, heard, job, master, asked, frame_count, message, length, wanted_mode,
               uploads, uploaded] = part;
  return std::tie(frame, received, sending, sent, lost, heard, job, master, asked, frame_count, message, length, wanted_mode,
                  uploads, uploaded);
}

auto members(const NetworkPort::Job& part) {
  const auto& [table, pointer, station, length, writes] = part;
  return std::tie(table, pointer, station, length, writes);
}

auto members(const NetworkPort& part) {
  const auto& [jobs, count, phase, tries, damaged, frame_count, status, number, accepted, data] = part;
  return std::tie(jobs, count, phase, tries, damaged, frame_count, status, number, accepted, data);
}

auto members(const TimerState& part) {
  const auto& [preset, enabled, off_delay, input, since] = part;
  return std::tie(preset, enabled, off_delay, input, since);
}

auto members(const HighSpeedCounter& part) {
  const auto& [defined, enabled, up, reset_low, start_low, single_rate, mode, current, preset] = part;
  return std::tie(defined, enabled, up, reset_low, start_low, single_rate, mode, current, preset);
}

auto members(const PulseTrain& part) {
  const auto& [pwm, profile, segments, table, unit, cycle, width, count] = part;
  return std::tie(pwm, profile, segments, table, unit, cycle, width, count);
}

auto members(const PulseOutput& part) {
  const auto& [running, has_next, train, next, last, left, segment, delta, cycle_end] = part;
  return std::tie(running, has_next, train, next, last, left, segment, delta, cycle_end);
}

auto members(const ClockTime& part) {
  const auto& [year, month, day, hour, minute, second, weekday] = part;
  return std::tie(year, month, day, hour, minute, second, weekday);
}

auto members(const RuntimeError& part) {
  const auto& [code, op, count, first] = part;
  return std::tie(code, op, count, first);
}

auto members(const ForcedPoints& part) {
  const auto& [mask, value] = part;
  return std::tie(mask, value);
}

auto members(const ForcedValue& part) {
  const auto& [at, value, width] = part;
  return std::tie(at, value, width);
}

auto members(const Forcing& part) {
  const auto& [inputs, outputs, memory, values, any] = part;
  return std::tie(inputs, outputs, memory, values, any);
}

auto members(const State& state) {
  const auto& [time, pc, stack, rail, eno, mode, phase, phase_left, in_interrupt, interrupts_enabled, stop_after_scan,
               stopped_by_master, call_depth, instructions, scans, scan_begin, watchdog, next_clock, shortest_scan,
               longest_scan, calls, local, saved, serving_event, serving_routine, serving_since, attached, queue, waiting,
               timed_interval, port, ppi, network, timer, previous_scan_begin, next_tick_1ms, ticks_100ms, counter_inputs,
               counter, pulse, clock, clock_set_at, station, diagnostic_led, eeprom, fatal_code, fatal_op, errors,
               error_count, forcing, terminals, analog_terminals, stop_outputs, image] = state;
  return std::tie(time, pc, stack, rail, eno, mode, phase, phase_left, in_interrupt, interrupts_enabled, stop_after_scan,
                  stopped_by_master, call_depth, instructions, scans, scan_begin, watchdog, next_clock, shortest_scan,
                  longest_scan, calls, local, saved, serving_event, serving_routine, serving_since, attached, queue, waiting,
                  timed_interval, port, ppi, network, timer, previous_scan_begin, next_tick_1ms, ticks_100ms, counter_inputs,
                  counter, pulse, clock, clock_set_at, station, diagnostic_led, eeprom, fatal_code, fatal_op, errors,
                  error_count, forcing, terminals, analog_terminals, stop_outputs, image);
}

template <class T>
constexpr bool kIsNumber = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// FNV-1a.
class Digest {
 public:
  void add(const void* data, std::size_t size) {
    for (const auto* byte = static_cast<const std::uint8_t*>(data); size > 0; --size, ++byte)
      sum_ = (sum_ ^ *byte) * 0x100000001B3;
  }
  void add(std::string_view text) { add(text.data(), text.size()); }

  template <class T>
  requires kIsNumber<T>
  void add(T number) {
    const auto bits = static_cast<std::uint64_t>(number);
    add(&bits, sizeof bits);
  }

  template <class T, std::size_t N>
  void add(const std::array<T, N>& all) {
    if constexpr (kIsNumber<T> && sizeof(T) == 1)
      add(all.data(), N);
    else
      for (const T& one : all) add(one);
  }

  template <class T>
  void add(const std::optional<T>& one) {
    add(one.has_value());
    if (one) add(*one);
  }

  template <class T>
  requires std::is_class_v<T>
  void add(const T& part) {
    std::apply([this](const auto&... member) { (this->add(member), ...); }, members(part));
  }

  std::string text() const { return fmt::format("{:016x}", sum_); }

 private:
  std::uint64_t sum_ = 0xCBF29CE484222325;
};

}  // namespace

std::string digest_of(std::string_view text) {
  Digest digest;
  digest.add(text);
  return digest.text();
}

std::string digest_of(const Program& program) {
  Digest digest;
  digest.add(program.model->name);
  for (std::uint32_t number = 0; number < program.ops.size(); ++number) {
    const Op& op = program.ops[number];
    const stl::Statement& statement = program.statement(number);
    digest.add(std::string_view(stl::to_text(statement)));
    digest.add(statement.position.line);
    digest.add(op.cost);
    digest.add(op.unit_cost);
    digest.add(op.target);
  }
  digest.add(program.constants.data(), program.constants.size());
  for (const InitialData& data : program.data) {
    digest.add(data.offset);
    digest.add(data.bytes.data(), data.bytes.size());
  }
  for (const Time time : {program.no_power_flow, program.interrupt_entry, program.eeprom_save}) digest.add(time);
  for (const Time time : program.scan_phase) digest.add(time);
  for (const std::uint32_t baud : program.system_block.ppi_rates) digest.add(baud);
  for (const std::uint8_t station : program.system_block.ppi_stations) digest.add(station);
  digest.add(program.system_block.second_request);
  if (program.system_block.retentive) digest.add(std::string_view(to_text(*program.system_block.retentive)));
  return digest.text();
}

std::string digest_of(const State& state) {
  Digest digest;
  digest.add(state);
  return digest.text();
}

std::string digest_of(const serial::FieldScript& script) {
  Digest digest;
  for (const serial::FieldChange& change : script.changes) {
    digest.add(change.at);
    digest.add(change.place);
    digest.add(change.mask);
    digest.add(change.value);
  }
  for (const serial::FieldPulses& pulses : script.pulses) {
    digest.add(pulses.at);
    digest.add(pulses.place);
    digest.add(pulses.mask);
    digest.add(pulses.pulses);
    digest.add(pulses.millihertz);
  }
  return digest.text();
}

}  // namespace s7200::tools
