#include "tools/scenario/plant.hpp"

#include <algorithm>

#include "tools/host/interruption.hpp"
#include "tools/views/machine_text.hpp"
#include "tools/views/memory.hpp"
#include "tools/views/report.hpp"

namespace s7200::tools {
namespace {

constexpr Time kSlice = 10 * kSecond;  // Ctrl-C is heard in between

}  // namespace

void InterruptCounter::record(const TraceRecord& record) {
  if (record.kind == TraceKind::ServiceBegin) ++routine_[record.routine];
  if (record.kind == TraceKind::EventOccurred) ++event_[record.event];
  if (record.kind == TraceKind::EventLost) ++lost_;
}

Plant::Plant(const Scenario& scenario, std::shared_ptr<const Program> program)
    : scenario_(scenario), program_(std::move(program)), timeline_(program_, nullptr) {
  sinks_.add(&timeline_);
  sinks_.add(&interrupts_);
  power_up(nullptr);
  if (scenario.clock) cpu().set_clock(*scenario.clock);
  for (const Assignment& assignment : scenario.set) assign(cpu(), assignment);
}

void Plant::power_up(const RetentiveMemory* memory) {
  slave_.reset();
  simulation_ = std::make_unique<serial::Simulation>(program_, scenario_.field);
  simulation_->cpu().set_sink(&sinks_);
  simulation_->stop_when(&interruption());
  simulation_->power_up(memory);
  slave_ = std::make_unique<SimulatedSlave>(*simulation_, scenario_.line, program_->source.name);
}

void Plant::power_cycle(bool memory_lost, Time power_off) {
  RetentiveMemory memory = cpu().retentive_memory();
  memory.ram_lost = memory_lost;
  memory.power_off = power_off;
  before_ += simulation_->time();
  power_up(&memory);
}

bool Plant::get_ready() {
  if (scenario_.after != kNever) {
    slave_->wait(scenario_.after - simulation_->time());
    return true;
  }
  const bool ready = slave_->get_ready(kReadyWithin);
  return ready || cpu().state().mode == Mode::Stop;
}

void Plant::begin_exchange() {
  timeline_.begin();
  interrupts_.begin();
}

bool Plant::wait_scans(std::uint64_t count) {
  cpu().pause_at_scan_end(true);
  const Time limit = simulation_->time() + kReadyWithin;
  for (; count > 0 && simulation_->run_until(limit) == serial::Halt::Paused; --count) {
  }
  cpu().pause_at_scan_end(false);
  simulation_->run_until(simulation_->time() + 1);  // running on, the CPU is no longer paused
  return count == 0;
}

bool Plant::wait_until(const std::function<bool()>& holds, Time timeout) {
  const Time limit = simulation_->time() + timeout;
  bool held = holds();
  cpu().pause_at_scan_end(true);
  while (!held && !interrupted() && simulation_->time() < limit) {
    const serial::Halt halt = simulation_->run_until(std::min(limit, simulation_->time() + kSlice));
    held = holds();
    if (halt == serial::Halt::Stopped) break;
  }
  cpu().pause_at_scan_end(false);
  cpu().run(simulation_->time());  // it is no longer paused
  return held;
}

std::string Plant::timeline(const serial::Exchange& exchange) const { return to_text(timeline_.report(), exchange, false); }

std::string Plant::why_stopped() {
  const std::string why = errors_text(cpu());
  return why.empty() ? "" : "\n" + why;
}

}  // namespace s7200::tools
