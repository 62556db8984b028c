#include "serial_sim/system/simulation.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace s7200::serial {

Simulation::Simulation(std::shared_ptr<const Program> program, FieldScript field, std::uint8_t port)
    : own_(std::make_unique<System>()),
      system_(own_.get()),
      port_(port),
      line_(&system_->add_line()),
      plc_(&system_->add_plc(lines(*program->model), program, std::move(field))),
      master_(&system_->add_requester(*line_)),
      host_(&system_->add_host_port(*line_)) {
  assert(port < program->model->ports);
}

Simulation::Simulation(System& system, SharedLine& line, Plc& plc, std::uint8_t port, RequesterStation* master,
                       HostStation* host)
    : system_(&system), port_(port), line_(&line), plc_(&plc), master_(master), host_(host) {}

/// The line, and those on which a port of the PLC is alone.
std::vector<SharedLine*> Simulation::lines(const CpuModel& model) {
  std::vector<SharedLine*> lines;
  for (std::uint8_t port = 0; port < model.ports; ++port) lines.push_back(port == port_ ? line_ : &system_->add_line());
  return lines;
}

void Simulation::let_master_follow(std::function<SerialFormat(const SerialFormat& port)> of) {
  if (!master_) return;
  const auto follow = [this, of = std::move(of)](const SerialFormat& port, Time at) {
    if (!master().asks()) master_uart().configure(of(port), at);
  };
  follow(port_format(), time());
  plc_->when_configured(follow, port_);
}

Halt Simulation::run_until(Time end) {
  Halt halt = Halt::Time;
  while (halt == Halt::Time && time() < end) {
    halt = system_->step(end);
    const State& state = cpu().state();
    if (halt == Halt::Time && system_->plcs() == 1 && state.mode == Mode::Stop && !state.stopped_by_master)
      halt = Halt::Stopped;
  }
  return halt;
}

bool Simulation::run_until_ready(const std::function<Time()>& quiet, Time limit) {
  cpu().pause_at_scan_end(true);
  Halt halt = Halt::Paused;
  while (halt == Halt::Paused && cpu().state().scans == 0) halt = run_until(limit);
  cpu().pause_at_scan_end(false);
  if (halt != Halt::Paused) return halt == Halt::Time && cpu().state().scans > 0;
  line_->note_activity(time());
  while (!line_quiet_for(quiet())) {
    const Time over = last_activity() + quiet();
    if (over > limit || run_until(over) != Halt::Time) return false;
  }
  return true;
}

}  // namespace s7200::serial
