#include "tools/command/running/send_band.hpp"

#include <fmt/format.h>

#include "tools/command/exit_code.hpp"
#include "tools/command/running/band_output.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/slave/simulated_slave.hpp"
#include "tools/views/report.hpp"

namespace s7200::tools {
namespace {

/// The exchanges with one table.
std::vector<BandOutcome> outcomes(const SendOptions& options, serial::Simulation& simulation, LostEvents& lost,
                                  const std::vector<serial::Frame>& frames, const std::string& name, RunRecorder* recorder) {
  SimulatedSlave slave(simulation, options.master, name, true);  // in STOP its port speaks PPI
  if (recorder) recorder->listen_to(slave);
  std::vector<BandOutcome> outcomes;
  bool going(slave.wait_until_ready(options.after));
  for (const serial::Frame& frame : frames) {
    if (!going) break;
    lost.take();
    serial::Exchange exchange = slave.exchange(options.master.request(frame));
    mark_request_of_another(exchange);
    going = !simulation.master().busy();
    if (going) slave.wait(options.pause == kNever ? slave.pause() : options.pause);
    const bool in_vain = exchange.timed_out || exchange.of_another_master;
    const char* const verdict = in_vain ? "no answer" : is_damaged(exchange) ? "damaged" : "answered";
    outcomes.push_back({exchange, verdict, lost.take(), stop_text(simulation.cpu())});
  }
  return outcomes;
}

std::string shortened(const serial::Frame& frame) {
  constexpr std::size_t kShown = 32;
  if (frame.size() <= kShown) return serial::to_hex(frame);
  return fmt::format("{} … {} characters", serial::to_hex(serial::Frame(frame.begin(), frame.begin() + kShown)),
                     frame.size());
}

}  // namespace

int run_send_band(SendOptions& options) {
  const auto frames = options.frames.read();
  if (!frames) return print_error(frames.why()), kUnusable;
  BandExchanges exchanges{.verb = "send", .key = "request", .labels = {}, .good = "answered", .run = {}};
  for (const serial::Frame& frame : *frames)
    exchanges.labels.push_back({"request  " + shortened(frame), plain_hex(serial::bytes_of(frame))});
  exchanges.run = [&](Rig& rig, const std::string& name, LostEvents& lost, RunRecorder* recorder) {
    return outcomes(options, rig.simulation(), lost, *frames, name, recorder);
  };
  return run_band(options.band, options.program, options.rig, options.report, options.json, exchanges);
}

}  // namespace s7200::tools
