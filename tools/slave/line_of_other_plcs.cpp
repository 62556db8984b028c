#include "tools/slave/line_of_other_plcs.hpp"

#include <utility>

namespace s7200::tools {

LineOfOtherPlcs::LineOfOtherPlcs(Rig& rig, std::size_t line, const serial::MasterSettings& master, std::string name)
    : MasterInSimulation(std::move(name)), system_(rig.system()), station_(*rig.requester(line)) {
  configure(on_line(master, rig.plan().lines[line]).over(format_without_s7200(rig.plan(), rig.plan().lines[line])));
}

bool LineOfOtherPlcs::wait_until_ready(Time after) {
  wait(after == kNever ? pause() : after);
  return !stop_requested();
}

}  // namespace s7200::tools
