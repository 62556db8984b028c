#include "tools/session/past/actions/journal.hpp"

#include <utility>

namespace s7200::tools {

Journal::Journal(serial::Simulation& simulation, std::vector<RetentiveMemory> memory, std::size_t most)
    : simulation_(simulation),
      most_(most),
      is_alone_(simulation.system().plcs() == 1 && !simulation.system().has_schedule()) {
  recording_.memory = std::move(memory);
}

void Journal::note(Action action, std::size_t station) {
  if (over_) return;
  if (recording_.actions.size() == most_) {
    recording_.end = now();
    over_ = true;
    return;
  }
  recording_.moments.push_back(now());
  recording_.actions.push_back(std::move(action));
  recording_.stations.push_back(station);
}

Moment Journal::now() const {
  return {.instructions = is_alone_ ? simulation_.plc().executed() : Moment::kNotCounted,
          .actions = recording_.actions.size(),
          .time = simulation_.time(),
          .stopped = is_alone_ && simulation_.cpu().state().mode == Mode::Stop};
}

Recording Journal::recording() const {
  Recording recording = recording_;
  if (!over_) recording.end = now();
  recording.now = recording.end;
  return recording;
}

}  // namespace s7200::tools
