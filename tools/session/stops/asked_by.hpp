// What the kinds of askers have in common: `send`, masters that poll, programs, and masters on bridges.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/session/past/history.hpp"
#include "tools/session/stops/heard_frames.hpp"

namespace s7200::tools {

/// A request that is over, without an answer or with one that whoever has asked cannot take.
struct EndedRequest {
  std::size_t line = 0;               ///< of PlcRequests::lines()
  std::vector<std::uint8_t> frame{};  ///< empty if it is not known; that of `send` is said with its answer
  Asker asker{};
  std::string wrong{};  ///< with its answer: `wrong CRC`; empty: it has none
  std::vector<std::uint8_t> answer{};
};

/// The requests of one kind of asker.
class AskedBy {
 public:
  /// What all kinds share; it must live as long as they do.
  struct Common {
    const History& history;
    std::function<void(const EndedRequest& request)> tell;
    Time host_timeout = kSecond;  ///< how long a master on a bridge and a program wait
  };

  explicit AskedBy(const Common& common) : common_(common) {}
  virtual ~AskedBy() = default;
  AskedBy(const AskedBy&) = delete;
  AskedBy& operator=(const AskedBy&) = delete;

  /// From now on; what was over by then is not told any more. `before`: the frames that came before.
  virtual void begin(Time now, const std::vector<HeardFrames::Frame>& before) = 0;

  /// A record that PlcRequests has not been told yet.
  virtual void note_record(std::size_t /*station*/, const TraceRecord& /*record*/) {}
  virtual void note_frame(const HeardFrames::Frame& /*frame*/) {}

  /// It is `now`: a request may be over.
  virtual void look(Time now) = 0;

  /// When the next of them is given up, if nothing comes; kNever if none waits.
  virtual Time next_timeout() const = 0;

  /// Whether one waits whose time-out is not an event of the simulation.
  virtual bool has_patient_one() const { return false; }

 protected:
  const History& history() const { return common_.history; }
  const PlcRequests& of_plcs() const { return common_.history.requests(); }
  Time host_timeout() const { return common_.host_timeout; }
  void tell(const EndedRequest& request) const { common_.tell(request); }

 private:
  const Common& common_;
};

/// When a master in the simulation gives its request up, if nothing comes; kNever if it does not wait.
inline Time timeout_of(const serial::Requester& requester) {
  const serial::Requester::State& state = requester.state();
  const bool waits = state.phase == serial::Requester::Phase::Waiting;
  return waits ? state.exchange.request_end + state.request.timeout : kNever;
}

}  // namespace s7200::tools
