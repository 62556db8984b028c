#include "tools/slave/simulated_slave.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "serial_sim/peers/quiet_time.hpp"
#include "tools/views/port_mode.hpp"

namespace s7200::tools {
SimulatedSlave::SimulatedSlave(serial::Simulation& simulation, const serial::MasterSettings& master, std::string name,
                               bool in_stop_too)
    : simulation_(simulation), master_(master), name_(std::move(name)), in_stop_too_(in_stop_too) {
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

bool SimulatedSlave::wait_until_ready(Time after, std::string& why) {
  const bool ready = after == kNever ? get_ready(kReadyWithin) : run_ready_until(after);
  if (!ready && after == kNever && simulation_.cpu().state().mode == Mode::Run && !stop_requested())
    why = fmt::format(
        "the program's first scan has not ended, or the line was never quiet for {}, within {}; --after TIME "
        "sends all the same",
        format_duration(pause()), format_duration(kReadyWithin));
  return ready;
}

std::string SimulatedSlave::note_on_port(bool wants_freeport) const {
  if (simulation_.freeport().active == wants_freeport) return {};
  if (!wants_freeport) return fmt::format("port {} is in Freeport mode: it does not speak PPI there", simulation_.port());
  return why_no_freeport(simulation_.cpu(), simulation_.port());
}

serial::Exchange SimulatedSlave::exchange(const serial::Request& request) {
  const SerialFormat format = this->format();
  if (serial::has_wrong_parity(request.frame) && format.parity == Parity::None)
    throw std::invalid_argument("a byte with wrong parity (p) needs a format with parity");
  simulation_.finish_exchange();  // what Ctrl-C has left under way
  remark_ = ignored_text(serial::bytes_of(simulation_.master().heard()));
  if (asked_) asked_(format, request);
  simulation_.configure_master(format);
  simulation_.master().start(request, simulation_.time());
  serial::Exchange exchange = simulation_.finish_exchange();
  if (simulation_.master().busy()) exchange.timed_out = exchange.response.empty();  // Ctrl-C ended the exchange
  if (const SerialFormat now = this->format(); now != format) simulation_.configure_master(now);
  return exchange;
}

serial::Exchange SimulatedSlave::receive(const serial::Listening& listening) {
  remark_.clear();
  simulation_.finish_exchange();
  simulation_.master().listen(listening, simulation_.time());
  serial::Exchange exchange = simulation_.finish_exchange();
  if (simulation_.master().busy()) exchange.timed_out = exchange.response.empty();
  return exchange;
}

void SimulatedSlave::wait(Time duration) { run_until(simulation_.time() + duration); }

Time SimulatedSlave::pause() const { return serial::default_quiet(format()); }

}  // namespace s7200::tools
