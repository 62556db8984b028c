// Why the first request that a program was asked got no answer: its run is played again when it is over.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/rig/rig.hpp"
#include "tools/session/past/journal.hpp"
#include "tools/slave/simulated_slave.hpp"

namespace s7200::tools {

class FirstUnanswered {
 public:
  static constexpr std::size_t kMostRequests = 2000;  ///< before it; a longer run keeps no more of them

  /// Of a rig that has just been powered up. `is_one_program`: of a system nothing is found out.
  FirstUnanswered(Rig& rig, bool is_one_program);

  /// Writes down what is asked from now on.
  void listen_to(SimulatedSlave& slave);

  /// An exchange is over.
  void note(const serial::Exchange& exchange);

  /// Why, a line each; none if all got an answer, or if the cause is not known. Captures of the line end here; the rig
  /// stands where it stood.
  std::vector<std::string> reasons(Time timeout);

 private:
  Rig& rig_;
  serial::System::Snapshot begin_;
  std::optional<Journal> journal_;
  std::optional<Recording> unanswered_;  // up to where it was given up
  std::size_t requests_ = 0;
};

/// The results with `why`, if there are reasons.
nlohmann::ordered_json with_why(nlohmann::ordered_json json, const std::vector<std::string>& reasons);

/// What is printed of that: a heading, and a line for each reason; nothing for none.
std::string why_text(const std::vector<std::string>& reasons);

}  // namespace s7200::tools
