// Writes down what is done to a simulation that runs by itself, so that a History can play that run again.
#pragma once

#include <cstddef>
#include <vector>

#include "tools/session/past/history.hpp"

namespace s7200::tools {

class Journal {
 public:
  /// The simulation has just been powered up, with `memory` if it is not empty. It must live as long as this.
  explicit Journal(const serial::Simulation& simulation, std::vector<RetentiveMemory> memory = {});

  /// What is about to be done.
  void note(Action action);

  /// Where it stands.
  Moment now() const;

  /// All that has been noted, up to now.
  Recording recording() const;

 private:
  const serial::Simulation& simulation_;
  Recording recording_{};
};

}  // namespace s7200::tools
