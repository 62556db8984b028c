// The scan: read inputs, execute the program, communication, self-test, write outputs (S7-200 manual C230-02, 6-10).
#include <algorithm>

#include "interpreter/cpu/cpu.hpp"

namespace s7200 {
namespace {

constexpr Time kHalfSecond = kSecond / 2;

/// Not documented, modelled so: SM0.4 and SM0.5 start with their 1 half at power-up.
/// [ScanCycle.TheClockOfHalfASecondChangesAtScanEnds, ScanCycle.TheClockOfHalfAMinuteChangesAtScanEnds]
std::uint8_t clock_bits(Time time) {
  const bool sm0_5 = (time / kHalfSecond) % 2 == 0;
  const bool sm0_4 = (time / (30 * kSecond)) % 2 == 0;
  return static_cast<std::uint8_t>(sm0_4 << 4 | sm0_5 << 5);
}

/// Not documented, modelled so: SMW22, SMW24 and SMW26 drop fractions of a millisecond and stop at 65535 ms.
/// [ScanCycle.LastShortestAndLongestScanInWholeMilliseconds, ScanCycle.AScanLongerThanAWordCanSayIs65535]
std::uint16_t whole_milliseconds(Time time) {
  return static_cast<std::uint16_t>(std::min<Time>(time / kMillisecond, 0xFFFF));
}

}  // namespace

/// Not documented, modelled so: SM0.6 is 0 in the first scan. [ScanCycle.SM06IsZeroInTheFirstScanAndThenAlternates]
void Cpu::enter_run() {
  s.mode = Mode::Run;
  s.image[image::kSM] = static_cast<std::uint8_t>((s.image[image::kSM] & 0x0C) | 0x83 | clock_bits(s.time));
  s.next_clock = (s.time / kHalfSecond + 1) * kHalfSecond;
  trace({.at = s.time, .kind = TraceKind::ModeChange, .code = 1});
  follow_port_control(s.time);
}

/// The output points go off: the default of the output table for STOP (facts 9.1).
void Cpu::enter_stop() {
  s.mode = Mode::Stop;
  s.in_interrupt = false;
  s.stop_after_scan = false;
  s.call_depth = 0;
  for (const InterruptEvent& event : all_events()) s.attached[event.number] = kNotAttached;
  for (const std::uint8_t what : {kTimedInterrupt0, kTimedInterrupt1, kTick1ms}) queue_.cancel(EventOwner::Cpu, what);
  s.next_tick_1ms = kNever;
  s.queue = {};
  s.waiting = 0;
  s.interrupts_enabled = false;
  s.image[image::kSM4] &= 0xE8;
  close_port();
  clear_outputs();
  trace({.at = s.time, .kind = TraceKind::ModeChange, .code = 0});
  s.phase = Phase::Communication;
  s.phase_left = program_->scan_phase[1];
  s.watchdog = kNever;
  attend();
}

void Cpu::begin_scan() {
  s.phase = Phase::ReadInputs;
  s.phase_left = program_->scan_phase[0];
  s.scan_begin = s.time;
  s.watchdog = s.mode == Mode::Run ? s.time + program_->model->watchdog : kNever;
  if (sink_) trace({.at = s.time, .kind = TraceKind::ScanBegin, .count = s.scans + 1});
}

void Cpu::system_phases() {
  while (s.phase != Phase::Program && !paused_ && s.time < until_) {
    const Time end = s.time + s.phase_left;
    if (end > until_) {
      s.phase_left = end - until_;
      s.time = until_;
      return;
    }
    s.time = end;
    s.phase_left = 0;
    finish_phase();
  }
}

void Cpu::finish_phase() {
  switch (s.phase) {
    case Phase::ReadInputs:
      std::memcpy(&s.image[image::kI], &s.image[image::kInputs], image::kPointBytes);
      if (s.mode == Mode::Run) {
        if (program_->uses_timers) update_timers_at_scan_begin();
        s.phase = Phase::Program;
        s.pc = 0;
        s.stack = {};
        s.rail = true;
        s.call_depth = 0;
        return;
      }
      [[fallthrough]];
    case Phase::Program:
      s.phase = Phase::Communication;
      s.phase_left = program_->scan_phase[1];
      return;
    case Phase::Communication:
      s.phase = Phase::SelfTest;
      s.phase_left = program_->scan_phase[2];
      return;
    case Phase::SelfTest:
      s.phase = Phase::WriteOutputs;
      s.phase_left = program_->scan_phase[3];
      return;
    case Phase::WriteOutputs:
      if (s.mode == Mode::Run) {
        if (std::memcmp(&s.image[image::kOutputs], &s.image[image::kQ], image::kPointBytes) != 0) write_outputs();
        if (begin_save_to_eeprom()) {
          s.phase = Phase::SaveToEeprom;
          s.phase_left = program_->eeprom_save;
          return;
        }
      }
      end_scan();
      return;
    case Phase::SaveToEeprom:
      end_save_to_eeprom();
      end_scan();
      return;
  }
}

void Cpu::end_scan() {
  if (s.mode == Mode::Run) {
    ++s.scans;
    // SMB0 is updated at the end of each scan (S7-200 manual, SMB0): SM0.1–SM0.3 last one scan, SM0.6 alternates.
    s.image[image::kSM] = static_cast<std::uint8_t>((s.image[image::kSM] & ~0x0E) ^ 0x40);
    if (s.time >= s.next_clock) update_clocks();
    const Time scan = s.time - s.scan_begin;
    const std::uint16_t last = whole_milliseconds(scan);
    store16(&s.image[image::kSM + 22], last);
    if (scan < s.shortest_scan) {
      s.shortest_scan = scan;
      store16(&s.image[image::kSM + 24], last);
    }
    if (scan > s.longest_scan) {
      s.longest_scan = scan;
      store16(&s.image[image::kSM + 26], last);
    }
    if (s.stop_after_scan) enter_stop();
    paused_ = pause_at_scan_end_;
  }
  begin_scan();
}

void Cpu::update_clocks() {
  s.image[image::kSM] = static_cast<std::uint8_t>((s.image[image::kSM] & ~0x30) | clock_bits(s.time));
  s.next_clock = (s.time / kHalfSecond + 1) * kHalfSecond;
}

void Cpu::end_main_program() {
  s.phase = Phase::Communication;
  s.phase_left = program_->scan_phase[1];
  attend();
}

/// STOP in the program stops at once; in an interrupt routine it ends the routine, drops what waits, and the scan is still
/// completed (facts 4.6).
void Cpu::stop() {
  if (!s.in_interrupt) {
    enter_stop();
    return;
  }
  s.queue = {};
  s.waiting = 0;
  s.interrupts_enabled = false;
  s.image[image::kSM4] &= 0xEF;
  s.stop_after_scan = true;
  return_from_interrupt();
}

void Cpu::call(std::uint32_t target) {
  if (s.call_depth == program_->model->call_depth) {
    run_error(RunError::CallDepth);
    return;
  }
  s.calls[s.call_depth++] = {s.pc, s.stack, s.rail};
  s.stack = LogicStack::on_entry();
  s.rail = true;
  s.pc = target;
}

void Cpu::return_from_subroutine() {
  const CallFrame& frame = s.calls[--s.call_depth];
  s.pc = frame.return_to;
  s.stack = frame.stack;
  s.rail = frame.rail;
}

}  // namespace s7200
