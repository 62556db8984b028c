#include "tools/command/running/send_slave.hpp"

#include "tools/command/terminal/terminal.hpp"
#include "tools/rig/first_scans.hpp"
#include "tools/slave/line_of_other_plcs.hpp"
#include "tools/slave/simulated_slave.hpp"

namespace s7200::tools {

std::unique_ptr<SlaveInSimulation> slave_to_send_to(const SendOptions& options, Rig& rig, bool& ready,
                                                    Unanswered* unanswered, RunRecorder* recorder) {
  if (options.rig.without_s7200()) {
    auto others = std::make_unique<LineOfOtherPlcs>(rig, options.rig.line(), options.master, options.rig.target());
    ready = others->wait_until_ready(options.after);
    return others;
  }
  // In STOP its port speaks PPI.
  auto program = std::make_unique<SimulatedSlave>(rig.simulation(), options.master, options.rig.target(), true);
  if (unanswered) unanswered->listen_to(*program);
  if (recorder) recorder->listen_to(*program);
  if (options.after == kNever) run_first_scans(rig, kReadyWithin);
  const auto waited = program->wait_until_ready(options.after);
  ready = bool(waited);
  if (ready) print_note_if_any(program->note_on_port());
  if (!waited.why().empty()) print_error(waited.why());
  return program;
}

}  // namespace s7200::tools
