// Facts 6.4. How timers count between two executions is in machine.cpp.
#include <algorithm>

#include "tests/reference_model/instructions.hpp"
#include "tests/reference_model/values.hpp"

namespace s7200::reference {
namespace {

/// `retentive`: TONR keeps current value and bit while it is off.
void time(Machine& m, bool retentive) {
  const std::size_t number = m.address(0).number;
  Machine::Timer& timer = m.timers[number];
  const auto preset = static_cast<std::int16_t>(m.in(1, 2));
  if (!m.stack[0]) {
    timer.enabled = false;
    if (retentive) return;
    write(Place{&m.memory.T, 2 * number}, 2, 0);
    write(BitPlace{&m.memory.timer_bits, number}, false);
    return;
  }
  timer.preset = preset;
  if (timer.enabled && is_100_ms(number)) m.count_timer(number, m.hundred_ms_ticks);
  if (!timer.enabled && !retentive) write(Place{&m.memory.T, 2 * number}, 2, 0);
  if (!timer.enabled) timer.enabled_at = m.time;
  timer.enabled = true;
  m.compare_timer(number);
}

/// TOF (facts 6.4): times after its input has gone off. In a segment without power it is reset.
void time_off(Machine& m) {
  const std::size_t number = m.address(0).number;
  Machine::Timer& timer = m.timers[number];
  timer.off_delay = true;
  timer.preset = static_cast<std::int16_t>(m.in(1, 2));
  const bool input = m.stack[0] && m.rail, went_off = timer.input && !m.stack[0] && m.rail;
  timer.input = input;
  if (input || !m.rail) {
    timer.enabled = false;
    write(Place{&m.memory.T, 2 * number}, 2, 0);
    return write(BitPlace{&m.memory.timer_bits, number}, input);
  }
  if (went_off) {
    timer.enabled = true;
    timer.enabled_at = m.time;
    write(Place{&m.memory.T, 2 * number}, 2, 0);
  } else if (!timer.enabled) {
    return write(BitPlace{&m.memory.timer_bits, number}, false);
  } else if (is_100_ms(number)) {
    m.count_timer(number, m.hundred_ms_ticks);
  }
  if (timer.enabled) m.compare_timer(number);
}

void compare_counter(Machine& m, std::size_t number, std::uint32_t preset) {
  const std::int32_t current = signed16(read(Place{&m.memory.C, 2 * number}, 2));
  write(BitPlace{&m.memory.counter_bits, number}, current >= signed16(preset));
}

void clear_counter(Machine& m, std::size_t number) {
  write(Place{&m.memory.C, 2 * number}, 2, 0);
  write(BitPlace{&m.memory.counter_bits, number}, false);
}

/// Whether `input` rises; `memory` follows it.
bool rises(bool& memory, bool input) {
  const bool rising = input && !memory;
  memory = input;
  return rising;
}

void count_up(Machine& m) {
  const std::size_t number = m.address(0).number;
  const std::uint32_t preset = m.in(1, 2);
  const bool reset = m.stack[0];
  const bool rising = rises(m.counter_up[number], m.stack[1]);
  m.pop();
  if (reset) return clear_counter(m, number);
  const Place current{&m.memory.C, 2 * number};
  if (rising && signed16(read(current, 2)) != 32767) write(current, 2, read(current, 2) + 1);
  compare_counter(m, number, preset);
}

void count_down(Machine& m) {
  const std::size_t number = m.address(0).number;
  const std::uint32_t preset = m.in(1, 2);
  const bool load = m.stack[0];
  const bool rising = rises(m.counter_down[number], m.stack[1]);
  m.pop();
  const Place current{&m.memory.C, 2 * number};
  if (load)
    write(current, 2, preset);
  else if (rising && signed16(read(current, 2)) > 0)
    write(current, 2, read(current, 2) - 1);
  write(BitPlace{&m.memory.counter_bits, number}, !load && signed16(read(current, 2)) <= 0);
}

void count_up_and_down(Machine& m) {
  const std::size_t number = m.address(0).number;
  const std::uint32_t preset = m.in(1, 2);
  const bool reset = m.stack[0];
  const bool down = rises(m.counter_down[number], m.stack[1]);
  const bool up = rises(m.counter_up[number], m.stack[2]);
  m.pop();
  m.pop();
  if (reset) return clear_counter(m, number);
  const Place current{&m.memory.C, 2 * number};
  if (up) write(current, 2, read(current, 2) + 1);
  if (down) write(current, 2, read(current, 2) - 1);
  compare_counter(m, number, preset);
}

}  // namespace

void add_timers_and_counters(Instructions& all) {
  all["TON"] = {false, [](Machine& m) { time(m, false); }};
  all["TONR"] = {false, [](Machine& m) { time(m, true); }};
  all["TOF"] = {false, time_off};
  all["CTD"] = {false, count_down};
  all["CTU"] = {false, count_up};
  all["CTUD"] = {false, count_up_and_down};
}

}  // namespace s7200::reference
