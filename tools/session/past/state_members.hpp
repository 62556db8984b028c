// The members of each part of a CPU's state, so that who writes all of it down, or reads it, writes each name once. A
// structured binding has to name them all: one that is added to a part is missed here by the compiler.
#pragma once

#include <concepts>
#include <tuple>
#include <type_traits>

#include "interpreter/cpu/state.hpp"

namespace s7200::tools {

/// A part of that type, const or not.
template <class Part, class Type>
concept Is = std::same_as<std::remove_const_t<Part>, Type>;

auto members(Is<CallFrame> auto& part) {
  auto& [return_to, stack, rail] = part;
  return std::tie(return_to, stack, rail);
}

auto members(Is<QueuedInterrupt> auto& part) {
  auto& [at, event, byte, parity_error] = part;
  return std::tie(at, event, byte, parity_error);
}

auto members(Is<InterruptQueue> auto& part) {
  auto& [entry, count] = part;
  return std::tie(entry, count);
}

auto members(Is<SavedContext> auto& part) {
  auto& [return_to, stack, rail, eno, accumulators, smb1, call_depth] = part;
  return std::tie(return_to, stack, rail, eno, accumulators, smb1, call_depth);
}

auto members(Is<SerialFormat> auto& part) {
  auto& [baud, data_bits, parity, stop_bits] = part;
  return std::tie(baud, data_bits, parity, stop_bits);
}

auto members(Is<MessageReceiver> auto& part) {
  auto& [phase, was_idle, had_break, control, start, end, most, idle_time, timeout, table, stored] = part;
  return std::tie(phase, was_idle, had_break, control, start, end, most, idle_time, timeout, table, stored);
}

auto members(Is<Freeport> auto& part) {
  auto& [control, active, transmitting, sending_break, on_line, on_wire, buffer, left, format, message] = part;
  return std::tie(control, active, transmitting, sending_break, on_line, on_wire, buffer, left, format, message);
}

auto members(Is<PpiPort> auto& part) {
  auto& [frame, received, sending, sent, lost, heard, job, master, asked, frame_count, message, length, wanted_mode, uploads,
         uploaded] = part;
  return std::tie(frame, received, sending, sent, lost, heard, job, master, asked, frame_count, message, length, wanted_mode,
                  uploads, uploaded);
}

auto members(Is<NetworkPort::Job> auto& part) {
  auto& [table, pointer, station, length, writes] = part;
  return std::tie(table, pointer, station, length, writes);
}

auto members(Is<NetworkPort> auto& part) {
  auto& [jobs, count, phase, tries, damaged, frame_count, status, number, accepted, data] = part;
  return std::tie(jobs, count, phase, tries, damaged, frame_count, status, number, accepted, data);
}

auto members(Is<TimerState> auto& part) {
  auto& [preset, enabled, off_delay, input, since] = part;
  return std::tie(preset, enabled, off_delay, input, since);
}

auto members(Is<HighSpeedCounter> auto& part) {
  auto& [defined, enabled, up, reset_low, start_low, single_rate, mode, current, preset] = part;
  return std::tie(defined, enabled, up, reset_low, start_low, single_rate, mode, current, preset);
}

auto members(Is<PulseTrain> auto& part) {
  auto& [pwm, profile, segments, table, unit, cycle, width, count] = part;
  return std::tie(pwm, profile, segments, table, unit, cycle, width, count);
}

auto members(Is<PulseOutput> auto& part) {
  auto& [running, has_next, train, next, last, left, segment, delta, cycle_end] = part;
  return std::tie(running, has_next, train, next, last, left, segment, delta, cycle_end);
}

auto members(Is<ClockTime> auto& part) {
  auto& [year, month, day, hour, minute, second, weekday] = part;
  return std::tie(year, month, day, hour, minute, second, weekday);
}

auto members(Is<RuntimeError> auto& part) {
  auto& [code, op, count, first] = part;
  return std::tie(code, op, count, first);
}

auto members(Is<ForcedPoints> auto& part) {
  auto& [mask, value] = part;
  return std::tie(mask, value);
}

auto members(Is<ForcedValue> auto& part) {
  auto& [at, value, width] = part;
  return std::tie(at, value, width);
}

auto members(Is<Forcing> auto& part) {
  auto& [inputs, outputs, memory, values, any] = part;
  return std::tie(inputs, outputs, memory, values, any);
}

auto members(Is<State> auto& state) {
  auto& [time, pc, stack, rail, eno, mode, phase, phase_left, in_interrupt, interrupts_enabled, stop_after_scan,
         stopped_by_master, call_depth, instructions, scans, scan_begin, watchdog, next_clock, shortest_scan, longest_scan,
         calls, local, saved, serving_event, serving_routine, serving_since, attached, queue, waiting, timed_interval, port,
         ppi, network, timer, previous_scan_begin, next_tick_1ms, ticks_100ms, counter_inputs, counter, pulse, clock,
         clock_set_at, station, diagnostic_led, eeprom, fatal_code, fatal_op, errors, error_count, forcing, terminals,
         analog_terminals, stop_outputs, image] = state;
  return std::tie(time, pc, stack, rail, eno, mode, phase, phase_left, in_interrupt, interrupts_enabled, stop_after_scan,
                  stopped_by_master, call_depth, instructions, scans, scan_begin, watchdog, next_clock, shortest_scan,
                  longest_scan, calls, local, saved, serving_event, serving_routine, serving_since, attached, queue, waiting,
                  timed_interval, port, ppi, network, timer, previous_scan_begin, next_tick_1ms, ticks_100ms, counter_inputs,
                  counter, pulse, clock, clock_set_at, station, diagnostic_led, eeprom, fatal_code, fatal_op, errors,
                  error_count, forcing, terminals, analog_terminals, stop_outputs, image);
}

}  // namespace s7200::tools
