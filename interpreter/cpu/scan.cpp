#include "interpreter/cpu/scan.hpp"

#include <algorithm>

#include "interpreter/cpu/interrupts.hpp"
#include "interpreter/cpu/local_memory.hpp"
#include "interpreter/cpu/network.hpp"
#include "interpreter/cpu/parameters.hpp"
#include "interpreter/cpu/ports/ppi.hpp"
#include "interpreter/cpu/units.hpp"
#include "interpreter/cpu/units/eeprom.hpp"
#include "interpreter/cpu/units/forcing.hpp"
#include "interpreter/cpu/units/points.hpp"

namespace s7200::scan {
namespace {

std::uint8_t clock_bits(const Core& core, Time time) {
  const bool one_second = (time / core.by_own_clock(kSecond / 2)) % 2 == 0;
  const bool one_minute = (time / core.by_own_clock(30 * kSecond)) % 2 == 0;
  return static_cast<std::uint8_t>((one_minute ? sm::kClock1min : 0) | (one_second ? sm::kClock1s : 0));
}

std::uint16_t whole_milliseconds(const Core& core, Time time) {
  return static_cast<std::uint16_t>(std::min<Time>(time / core.by_own_clock(kMillisecond), 0xFFFF));
}

void update_clocks(const Core& core, State& s, Time at) {
  const Time half_second = core.by_own_clock(kSecond / 2);
  std::uint8_t& status = s.image[sm::kScanStatus];
  status = static_cast<std::uint8_t>((status & ~(sm::kClock1min | sm::kClock1s)) | clock_bits(core, at));
  s.next_clock = (at / half_second + 1) * half_second;
}

/// SMB0 is updated at the end of each scan (S7-200 manual, SMB0): SM0.1–SM0.3 last one scan, SM0.6 alternates.
void update_status(Core& core) {
  State& s = core.s;
  std::uint8_t& status = s.image[sm::kScanStatus];
  constexpr std::uint8_t kOneScan = sm::kFirstScan | sm::kRetentiveLost | sm::kFromPowerUp;
  status = static_cast<std::uint8_t>((status & ~kOneScan) ^ sm::kAlternatingScan);
  if (s.time >= s.next_clock) update_clocks(core, s, s.time);
}

/// A scan has taken so long. Inlined, because a scan may be short.
[[gnu::always_inline]] inline void update_times(const Core& core, State& s, Time scan) {
  const std::uint16_t last = whole_milliseconds(core, scan);
  store16(&s.image[sm::kLastScan], last);
  if (scan < s.shortest_scan) {
    s.shortest_scan = scan;
    store16(&s.image[sm::kShortestScan], last);
  }
  if (scan > s.longest_scan) {
    s.longest_scan = scan;
    store16(&s.image[sm::kLongestScan], last);
  }
}

void end(Core& core) {
  if (core.s.mode == Mode::Run) {
    ++core.s.scans;
    update_status(core);
    update_times(core, core.s, core.s.time - core.s.scan_begin);
    if (core.s.stop_after_scan) enter_stop(core);
    core.loop.paused = core.loop.pause_at_scan_end;
  }
  const Time scan = core.s.time - core.s.scan_begin;
  begin(core);
  core.s.phase_left = std::max<Time>(core.s.phase_left + core.by_own_clock(scan) - scan, 0);
}

void begin_phase(Core& core, Phase phase, Program::ScanPart part) {
  core.s.phase = phase;
  core.s.phase_left = core.program().scan_phase[part];
}

void begin_program(Core& core) {
  State& s = core.s;
  units::begin_scan(core);
  s.phase = Phase::Program;
  s.pc = 0;
  s.stack = {};
  s.rail = true;
  s.eno = true;
  local_memory::put_aside(core);
  s.call_depth = 0;
  local_memory::take_up(core);
}

void begin_communication(Core& core) { begin_phase(core, Phase::Communication, Program::kCommunication); }

void communicate(Core& core) {
  const Mode before = core.s.mode;
  forcing::apply(core);  // what a master reads is forced
  network::communicate(core);
  for (std::uint8_t port = 0; port < core.s.ppi.size(); ++port)
    if (ppi::waits(core.s.ppi[port])) ppi::communicate(core, port);
  if (core.s.mode != before) return;
  forcing::apply(core);  // so is what it has written
  begin_phase(core, Phase::SelfTest, Program::kSelfTest);
}

void read_inputs(Core& core) {
  points::read_inputs(core);
  core.s.mode == Mode::Run ? begin_program(core) : begin_communication(core);
}

/// Whether the scan is over: to save a value adds a phase to it.
bool finish_outputs(Core& core) {
  if (core.s.phase == Phase::SaveToEeprom) {
    eeprom::end_save(core);
    return true;
  }
  if (core.s.mode == Mode::Run) units::end_scan(core);
  return core.s.phase == Phase::WriteOutputs;
}

/// Spends the time of the phase; whether it is over before the loop has to look for other work.
bool spend_phase(Core& core) {
  State& s = core.s;
  const Time until = core.loop.until, end = s.time + s.phase_left;
  if (s.time >= until) return false;
  if (end > until) {
    s.phase_left = end - until;
    s.time = until;
    return false;
  }
  s.time = end;
  s.phase_left = 0;
  return true;
}

/// Advances from the phase that the scan is in to the next program, or to where the order is another one. Most scans go
/// through all phases.
void advance_in_order(Core& core) {
  switch (core.s.phase) {
    case Phase::Communication:
      if (!spend_phase(core)) return;
      communicate(core);
      if (core.s.phase != Phase::SelfTest) return;
      [[fallthrough]];
    case Phase::SelfTest:
      if (!spend_phase(core)) return;
      begin_phase(core, Phase::WriteOutputs, Program::kWriteOutputs);
      [[fallthrough]];
    case Phase::WriteOutputs:
    case Phase::SaveToEeprom:
      if (!spend_phase(core) || !finish_outputs(core)) return;
      end(core);
      if (core.loop.paused) return;
      [[fallthrough]];
    case Phase::ReadInputs:
      if (spend_phase(core)) read_inputs(core);
      return;
    case Phase::Program:
      return;
  }
}

}  // namespace

void enter_run(Core& core) {
  State& s = core.s;
  s.mode = Mode::Run;
  s.stopped_by_master = false;
  constexpr std::uint8_t kKept = sm::kRetentiveLost | sm::kFromPowerUp | sm::kModeSwitchRun;
  std::uint8_t& status = s.image[sm::kScanStatus];
  status = static_cast<std::uint8_t>((status & kKept) | sm::kAlwaysOn | sm::kFirstScan);
  update_clocks(core, s, s.time);
  for (const Op& op : core.program().ops)
    if (op.instruction->hidden == Hidden::LoopMemory) core.put_bit(op[2].at, op[2].bit, true);
  core.trace({.at = s.time, .kind = TraceKind::ModeChange, .code = 1});
  units::enter_run(core);
}

void enter_stop(Core& core) {
  State& s = core.s;
  s.mode = Mode::Stop;
  local_memory::put_aside(core);
  s.in_interrupt = false;
  s.stop_after_scan = false;
  s.call_depth = 0;
  local_memory::take_up(core);
  units::enter_stop(core);
  core.trace({.at = s.time, .kind = TraceKind::ModeChange, .code = 0});
  begin_communication(core);
  s.watchdog = kNever;
  core.attend();
}

void change_mode(Core& core, Mode wanted) {
  if (wanted == core.s.mode) return;
  if (wanted == Mode::Stop) {
    enter_stop(core);
    core.s.stopped_by_master = true;
  } else {
    enter_run(core);
    begin(core);
  }
}

void begin(Core& core) {
  State& s = core.s;
  begin_phase(core, Phase::ReadInputs, Program::kReadInputs);
  s.scan_begin = s.time;
  s.watchdog = s.mode == Mode::Run ? s.time + core.by_own_clock(core.model().watchdog) : kNever;
  if (core.sink()) core.trace({.at = s.time, .kind = TraceKind::ScanBegin, .count = s.scans + 1});
}

void advance(Core& core) {
  do advance_in_order(core);
  while (core.s.phase != Phase::Program && core.s.time < core.loop.until && !core.loop.paused);
}

void pass(const Core& core, State& s, Time by) {
  s.scan_begin += by;
  update_clocks(core, s, s.scan_begin);  // as at the end of the scan before
}

void end_alike(const Core& core, State& s, Time scans, Time at, Time each) {
  s.scans += static_cast<std::uint64_t>(scans);
  if (scans % 2 != 0) s.image[sm::kScanStatus] ^= sm::kAlternatingScan;
  if (at >= s.next_clock) update_clocks(core, s, at);
  update_times(core, s, at - (scans - 1) * each - s.scan_begin);
  if (scans > 1) update_times(core, s, each);
  s.scan_begin = at;
  s.watchdog = at + core.by_own_clock(core.model().watchdog);
}

void end_main_program(Core& core) {
  begin_communication(core);
  core.attend();
}

void stop(Core& core) {
  if (!core.s.in_interrupt) return enter_stop(core);
  interrupts::drop_all(core);
  core.s.stop_after_scan = true;
  interrupts::return_from(core);
}

void reset_watchdog(Core& core) {
  core.s.watchdog = core.s.time + core.by_own_clock(core.model().watchdog);
  core.attend();
}

bool call(Core& core, std::uint32_t target) {
  State& s = core.s;
  const std::uint32_t deepest =
      s.in_interrupt ? s.saved.call_depth + core.model().interrupt_call_depth : core.model().call_depth;
  if (s.call_depth == deepest) {
    core.run_error(RunError::CallDepth);
    return false;
  }
  local_memory::put_aside(core);
  s.calls[s.call_depth++] = {s.pc, s.stack, s.rail};
  local_memory::take_up(core);
  s.stack = LogicStack::on_entry();
  s.rail = true;
  s.pc = target;
  return true;
}

void return_from_subroutine(Core& core) {
  State& s = core.s;
  const CallFrame& frame = s.calls[s.call_depth - 1];
  const Op& call = core.program().ops[frame.return_to - 1];
  const parameters::Values results = parameters::results(core, call);
  local_memory::put_aside(core);
  --s.call_depth;
  local_memory::take_up(core);
  parameters::hand_back(core, call, results);
  s.pc = frame.return_to;
  s.stack = frame.stack;
  s.rail = frame.rail;
  s.eno = true;
}

void power_up(Core& core, const RetentiveMemory*) { core.s.image[sm::kScanStatus] = sm::kAlwaysOn | sm::kFromPowerUp; }

}  // namespace s7200::scan
