// Why requests that programs were asked got no answer: the run is played again when it is over.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/command/reports/run_recorder.hpp"
#include "tools/rig/files/recorded_rig.hpp"
#include "tools/session/past/actions/journal.hpp"
#include "tools/session/past/seen_rig.hpp"
#include "tools/slave/simulated_slave.hpp"

namespace s7200::tools {

/// Requests that got no answer for the same reason.
struct SameCause {
  std::size_t requests = 0;
  Bytes first{};                   ///< the first of them
  Time at = 0;                     ///< when it began
  std::vector<std::string> why{};  ///< of that one, a line each, in a system with the station concerned in front; empty: the
                                   ///< cause is not known
};

/// All of a run.
struct UnansweredRequests {
  std::vector<SameCause> causes{};  ///< in the order in which they came up
  std::size_t not_explained = 0;    ///< further requests, beyond the bounds of Unanswered
};

class Unanswered {
 public:
  static constexpr std::size_t kMostExplained = 50;  ///< each of them takes a part of the run once more

  /// Of a rig that has just been powered up, with an S7-200 at `spot`, where the requests are asked.
  Unanswered(RecordedRig& rig, const Spot& spot);

  /// Writes down what is asked from now on.
  void listen_to(SimulatedSlave& slave);

  /// An exchange is over. A broadcast has no answer.
  void note(const serial::Exchange& exchange);

  /// Captures of the line end here; the rig stands where it stood. None after an interruption.
  UnansweredRequests explained(Time timeout);

 private:
  struct Request {
    Bytes frame{};
    Time at = 0;
    Moment given_up{};
  };

  RecordedRig& rig_;
  SeenRig seen_;
  std::size_t station_;  ///< beside which the master stands
  serial::System::Snapshot begin_;
  Journal journal_;
  std::optional<Recording> recording_{};  ///< up to the last of those that are to be explained
  std::vector<Request> unanswered_{};
  std::size_t not_explained_ = 0;
};

/// What masters on a bridge have asked in vain, while a run follows the clock.
class UnansweredOnBridge {
 public:
  static constexpr std::size_t kMostActions = 10'000;  ///< of what comes in: an hour of a master that asks every second

  /// Of a rig that has just been powered up, with an S7-200 at `spot`, where the bridge has joined; all must live as long.
  UnansweredOnBridge(RecordedRig& rig, const Spot& spot, const RunRecorder& recorder);

  /// The simulation has caught up with the clock. What comes after the last request need not be played again.
  void look();

  /// The rig stands where it stood. Left out are what has no cause that is known, and programs that listen and never speak.
  /// It takes a few seconds at most.
  UnansweredRequests explained() const;

 private:
  void explain(History& history, StopToken stop, UnansweredRequests& all) const;
  Recording recording() const;
  bool only_listens() const;

  RecordedRig& rig_;
  Spot spot_;
  const RunRecorder& recorder_;
  serial::System::Snapshot begin_;
  Time sent_until_ = 0;            // by whoever is on the bridge
  std::optional<Moment> quiet_{};  // when the last request had waited for long enough
};

/// Why the causes of missing answers are not told of somebody who is outside the simulation, or of a PLC of another make.
std::string note_on_unknown_causes(const std::string& slave, bool is_simulated);

/// The results with `why` and `unanswered`, if there are such requests.
nlohmann::ordered_json with_why(nlohmann::ordered_json json, const UnansweredRequests& unanswered);

/// What is printed of that: for each cause a heading, and a line for each reason; nothing for none.
std::string why_text(const UnansweredRequests& unanswered);

}  // namespace s7200::tools
