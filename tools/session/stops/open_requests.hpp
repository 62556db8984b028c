// Requests on the lines that wait for an answer, whoever has asked, and when one is over without a right one.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "tools/session/stops/asked_by_bridges.hpp"
#include "tools/session/stops/asked_by_pollers.hpp"
#include "tools/session/stops/asked_by_programs.hpp"
#include "tools/session/stops/asked_by_send.hpp"

namespace s7200::tools {

class OpenRequests {
 public:
  /// The history must live as long as this.
  explicit OpenRequests(const History& history);
  OpenRequests(const OpenRequests&) = delete;
  OpenRequests& operator=(const OpenRequests&) = delete;

  /// Told of each that is over without an answer, or with a wrong one; must be set.
  void when_ended(std::function<void(const EndedRequest& request)> tell) { common_.tell = std::move(tell); }

  /// How long a master on a bridge and a program wait.
  Time host_timeout() const { return common_.host_timeout; }
  void set_host_timeout(Time timeout) { common_.host_timeout = timeout; }

  /// From now on. `before`: the frames that came before.
  void begin(Time now, const std::vector<HeardFrames::Frame>& before);

  /// Which of the masters of `send` are asking; of those take_finished() tells.
  void await_masters() { send_.await(); }
  void await_no_masters() { send_.await_none(); }

  /// A record that PlcRequests has not been told yet.
  void note_record(std::size_t station, const TraceRecord& record);
  void note_frame(const HeardFrames::Frame& frame);

  /// It is `now`: a time-out may be over.
  void look(Time now);

  /// The stations at whose masters of `send` an exchange is over that was awaited: it has its answer, or none has come.
  std::vector<std::size_t> take_finished() { return send_.take_finished(); }

  /// When the next of them is given up, if nothing comes; kNever if none waits.
  Time next_timeout() const;

  /// Whether a master on a bridge or a program waits, whose time-out is not an event of the simulation.
  bool has_patient_one() const;

 private:
  AskedBy::Common common_;
  AskedBySend send_;
  AskedByPollers pollers_;
  AskedByPrograms programs_;
  AskedByBridges bridges_;
  std::array<AskedBy*, 4> all_{};  ///< in the order in which they are told and looked at
};

}  // namespace s7200::tools
