#include "tools/session/past/journal.hpp"

#include <utility>

namespace s7200::tools {

Journal::Journal(const serial::Simulation& simulation, std::vector<RetentiveMemory> memory) : simulation_(simulation) {
  recording_.memory = std::move(memory);
}

void Journal::note(Action action) {
  recording_.moments.push_back(now());
  recording_.actions.push_back(std::move(action));
  recording_.stations.push_back(0);
}

Moment Journal::now() const {
  return {.instructions = simulation_.plc().executed(),
          .actions = recording_.actions.size(),
          .time = simulation_.time(),
          .stopped = simulation_.cpu().state().mode == Mode::Stop};
}

Recording Journal::recording() const {
  Recording recording = recording_;
  recording.end = recording.now = now();
  return recording;
}

}  // namespace s7200::tools
