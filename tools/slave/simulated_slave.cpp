#include "tools/slave/simulated_slave.hpp"

#include <fmt/format.h>

#include <utility>

#include "tools/views/state/machine_text.hpp"
#include "tools/views/state/port_mode.hpp"

namespace s7200::tools {
SimulatedSlave::SimulatedSlave(serial::Simulation& simulation, const serial::MasterSettings& master, std::string name,
                               bool in_stop_too)
    : MasterInSimulation(std::move(name)), simulation_(simulation), master_(master), in_stop_too_(in_stop_too) {
  simulation_.let_master_follow([line = serial::LineSettings(master)](const SerialFormat& port) { return line.over(port); });
}

bool SimulatedSlave::goes_on_in_stop() const {
  const State& state = simulation_.cpu().state();
  return state.mode == Mode::Stop && state.fatal_code == 0 && !stop_requested();
}

/// Runs until `end`. Returns false after a fatal error and after Ctrl-C.
bool SimulatedSlave::run_until(Time end) {
  if (simulation_.run_until(end) == serial::Halt::Time) return true;
  return goes_on_in_stop() && simulation_.system().run_until(end) == serial::Halt::Time;
}

/// Runs until ready. Returns false as soon as the CPU is in STOP if nothing answers there.
bool SimulatedSlave::run_ready_until(Time end) {
  return in_stop_too_ ? run_until(end) : simulation_.run_until(end) == serial::Halt::Time;
}

bool SimulatedSlave::get_ready(Time limit) {
  if (simulation_.run_until_ready([this] { return pause(); }, limit)) return true;
  return in_stop_too_ && goes_on_in_stop() && run_until(simulation_.time() + pause());
}

Result<> SimulatedSlave::wait_until_ready(Time after) {
  if (after == kNever ? get_ready(kReadyWithin) : run_ready_until(after)) return {};
  if (after == kNever && simulation_.cpu().state().mode == Mode::Run && !stop_requested())
    return trouble(
        "the program's first scan has not ended, or the line was never quiet for {}, within {}; --after TIME "
        "sends all the same",
        format_duration(pause()), format_duration(kReadyWithin));
  return Trouble{};
}

std::string SimulatedSlave::note_on_port(bool wants_freeport) const {
  if (simulation_.freeport().active == wants_freeport) return {};
  if (!wants_freeport) return fmt::format("port {} is in Freeport mode: it does not speak PPI there", simulation_.port());
  const std::string why = why_no_freeport(simulation_.cpu(), simulation_.port());
  return why.empty() ? "" : fmt::format("{} when the first request comes, at {}", why, moment_text(simulation_.time()));
}

void SimulatedSlave::wait(Time duration) { run_until(simulation_.time() + duration); }

}  // namespace s7200::tools
