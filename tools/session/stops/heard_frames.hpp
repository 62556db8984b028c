// What the ports of the PLCs hear: characters, and frames, which end when nothing has come for 3.5 characters.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "tools/session/past/history.hpp"

namespace s7200::tools {

class HeardFrames {
 public:
  struct Frame {
    std::size_t station = 0;  ///< that has heard it
    std::uint8_t port = 0;
    std::vector<std::uint8_t> bytes{};
    Time end = 0;
  };

  /// Of all ports of all stations. The history must live as long as this.
  explicit HeardFrames(const History& history);

  std::function<void(const Frame&)> on_frame;  ///< one has ended; must be set

  /// Hears from now on, and goes on with what each port is hearing.
  void begin();

  /// Must be told the records of all stations, in their order.
  void note(std::size_t station, const TraceRecord& record);

  /// It is `now` at a station, and at those that execute nothing: frames may have ended.
  void look(std::size_t station, Time now);

  /// When a frame that is coming in ends, if nothing else comes; kNever if none is.
  Time next_end() const;

  /// Those that came last, and had ended before it began to hear.
  std::vector<Frame> frames_before() const;

  /// The last character that a port has heard since its program has sent anything.
  const std::optional<Time>& last_heard(std::size_t station, std::uint8_t port) const {
    return ears_[first_ear_[station] + port].last_heard;
  }

 private:
  struct Ear {
    std::size_t station = 0;
    std::uint8_t port = 0;
    const serial::Plc* plc = nullptr;
    const serial::SharedLine* line = nullptr;
    std::vector<std::uint8_t> coming_in{};  ///< characters since the last silence
    Time silence_noted = 0;                 ///< after the character that ended then; 0: after none
    bool came_in = false;                   ///< the last character on the line was received
    std::optional<Time> last_heard{};
  };

  static Time silence(const Ear& ear) { return ear.plc->port_format(ear.port).silence(); }
  void begin(Ear& ear, const serial::Plc::State& state) const;
  const std::vector<std::uint8_t>& heard_last(const Ear& ear) const;
  void note_silence(Ear& ear, Time now) const;

  const History& history_;
  std::vector<Ear> ears_;               ///< by station and port
  std::vector<std::size_t> first_ear_;  ///< by station
};

}  // namespace s7200::tools
