#include "serial_sim/system/simulation.hpp"

#include <algorithm>
#include <utility>

namespace s7200::serial {
namespace {

enum Driver { kPlc, kMaster, kHost };

/// So far the CPU runs without a look at a stop request: a moment of the host, even when every instruction is traced. What
/// is computed does not depend on it.
constexpr Time kLookEvery = 100 * kMillisecond;

}  // namespace

Simulation::Simulation(std::shared_ptr<const Program> program, FieldScript field)
    : plc_uart_(line_, queue_, EventOwner::PlcUart, kPlc),
      master_uart_(line_, queue_, EventOwner::MasterUart, kMaster),
      host_uart_(line_, queue_, EventOwner::HostUart, kHost, false),
      master_(master_uart_, queue_),
      host_port_(host_uart_),
      cpu_(std::move(program), queue_, port_),
      field_(std::move(field), cpu_, queue_),
      faults_(line_, queue_, plc_uart_),
      tap_(line_, kPlc) {
  plc_uart_.enable_receiver(false, 0);
}

void Simulation::power_up(const RetentiveMemory* memory) {
  cpu_.power_up(true, memory);
  field_.power_up();
}

void Simulation::Port::configure(const SerialFormat& format) {
  simulation_.plc_uart_.configure(format);
  if (simulation_.master_format_ && !simulation_.master_.asks())
    simulation_.master_uart_.configure(simulation_.master_format_(format));
}

void Simulation::let_master_follow(std::function<SerialFormat(const SerialFormat& port)> of) {
  master_format_ = std::move(of);
  if (!master_.asks()) master_uart_.configure(master_format_(cpu_.state().port[0].format));
}

Halt Simulation::run_until(Time end) {
  while (cpu_.time() < end) {
    if (stop_requested()) return Halt::Request;
    cpu_.run(std::min(end, next_look()));
    handle_due_events();
    if (cpu_.paused()) return Halt::Paused;
    if (cpu_.state().mode == Mode::Stop) return Halt::Stopped;
  }
  return Halt::Time;
}

const Exchange& Simulation::finish_exchange() {
  while (master_.busy() && !cpu_.paused() && !stop_requested()) {
    cpu_.run(next_look());
    handle_due_events();
  }
  return master_.exchange();
}

Time Simulation::next_look() const { return cpu_.time() < kNever - kLookEvery ? cpu_.time() + kLookEvery : kNever; }

bool Simulation::line_quiet_for(Time quiet) const { return cpu_.time() - last_activity_ >= quiet; }

bool Simulation::run_until_ready(const std::function<Time()>& quiet, Time limit) {
  cpu_.pause_at_scan_end(true);
  Halt halt = Halt::Paused;
  while (halt == Halt::Paused && cpu_.state().scans == 0) halt = run_until(limit);
  cpu_.pause_at_scan_end(false);
  if (halt != Halt::Paused) return halt == Halt::Time && cpu_.state().scans > 0;
  last_activity_ = std::max(last_activity_, cpu_.time());
  while (!line_quiet_for(quiet())) {
    const Time over = last_activity_ + quiet();
    if (over > limit || run_until(over) != Halt::Time) return false;
  }
  return true;
}

void Simulation::handle_due_events() {
  while (queue_.next() <= cpu_.time()) {
    tap_.settle(queue_.next(), plc_uart_.state().format);  // whatever is sent from now on begins no earlier
    dispatch(queue_.pop());
  }
  tap_.settle(cpu_.time(), plc_uart_.state().format);
}

void Simulation::dispatch(const Event& event) {
  switch (event.owner) {
    case EventOwner::Faults:
      faults_.handle(event);
      break;
    case EventOwner::PlcUart: {
      const Uart::Report report = plc_uart_.handle(event);
      note_activity(report);
      if (report.received) cpu_.character_received(*report.received);
      if (report.sent) cpu_.character_sent(*report.sent);
      break;
    }
    case EventOwner::MasterUart: {
      const Uart::Report report = master_uart_.handle(event);
      note_activity(report);
      master_.on(report);
      break;
    }
    case EventOwner::HostUart: {
      const Uart::Report report = host_uart_.handle(event);
      note_activity(report);
      host_port_.on(report);
      break;
    }
    case EventOwner::Cpu:
      cpu_.handle(event);
      break;
    case EventOwner::Field:
      field_.handle(event);
      break;
    case EventOwner::Master:
      master_.handle(event);
      break;
  }
}

void Simulation::note_activity(const Uart::Report& report) {
  if (report.sent) last_activity_ = std::max(last_activity_, *report.sent);
  if (report.received) last_activity_ = std::max(last_activity_, report.received->end);
}

Simulation::Snapshot Simulation::snapshot() const {
  return {cpu_.state(),
          queue_,
          line_,
          plc_uart_.state(),
          master_uart_.state(),
          host_uart_.state(),
          master_.state(),
          host_port_.state(),
          last_activity_,
          field_.state(),
          faults_.state()};
}

void Simulation::restore(const Snapshot& snapshot) {
  cpu_.restore(snapshot.cpu);
  queue_ = snapshot.queue;
  line_ = snapshot.line;
  plc_uart_.restore(snapshot.plc_uart);
  master_uart_.restore(snapshot.master_uart);
  host_uart_.restore(snapshot.host_uart);
  master_.restore(snapshot.master);
  host_port_.restore(snapshot.host_port);
  last_activity_ = snapshot.last_activity;
  field_.restore(snapshot.field);
  faults_.restore(snapshot.faults);
  tap_.go_back(cpu_.time());
}

}  // namespace s7200::serial
