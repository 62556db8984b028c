#include "tools/rig/first_scans.hpp"

#include <algorithm>

namespace s7200::tools {
namespace {

bool all_have_scanned(const Rig& rig) {
  for (std::size_t i = 0; i < rig.plan().plcs.size(); ++i) {
    const serial::Plc& plc = rig.plc(i);
    const State& state = plc.cpu().state();
    if (plc.powered() && state.mode == Mode::Run && state.scans == 0) return false;
  }
  return true;
}

}  // namespace

bool run_first_scans(Rig& rig, Time limit) {
  if (rig.plan().plcs.size() == 1) return true;
  serial::System& system = rig.system();
  while (!all_have_scanned(rig)) {
    if (system.time() >= limit) return false;
    if (system.run_until(std::min(limit, system.time() + kMillisecond)) != serial::Halt::Time) return false;
  }
  return true;
}

}  // namespace s7200::tools
