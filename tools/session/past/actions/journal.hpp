// Writes down what is done to a simulation that runs by itself, so that a History can play that run again.
#pragma once

#include <cstddef>
#include <vector>

#include "tools/session/past/history.hpp"

namespace s7200::tools {

class Journal {
 public:
  /// How many actions a journal keeps if no other number is given, so that a run of any length needs constant memory.
  static constexpr std::size_t kMostActions = 1000;

  /// The simulation has just been powered up, with `memory` if it is not empty. It must live as long as this. Of a system it
  /// is any of its PLCs.
  explicit Journal(serial::Simulation& simulation, std::vector<RetentiveMemory> memory = {},
                   std::size_t most = kMostActions);

  /// Whether more has been done than is kept: the run can be played again only up to there.
  bool is_over() const { return over_; }

  /// What is about to be done to a station, or on its line.
  void note(Action action, std::size_t station = 0);

  /// Where it stands.
  Moment now() const;

  /// All that is kept, up to now or to where the journal was over.
  Recording recording() const;

 private:
  serial::Simulation& simulation_;
  std::size_t most_;
  bool is_alone_;  ///< nothing but the PLC's own clock tells one moment from another
  Recording recording_{};
  bool over_ = false;
};

}  // namespace s7200::tools
