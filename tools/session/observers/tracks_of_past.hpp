// What happened in a part of the past, as the tracks of a timeline, put together by playing it again.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/serial_format.hpp"
#include "interpreter/base/stop_token.hpp"
#include "interpreter/program/operands/address.hpp"
#include "tools/session/observers/track.hpp"
#include "tools/session/past/history.hpp"

namespace s7200::tools {

/// The kinds of tracks, in the order in which they are shown.
enum class TrackKind : std::uint8_t {
  Characters,
  Frames,
  Interrupts,
  Queues,  ///< how many interrupts wait in one
  Scans,
  Routines,
  Networks,
  Events,
  Errors,
  Value
};
/// Whether its elements are numbers from one change to the next.
constexpr bool is_of_numbers(TrackKind kind) { return kind == TrackKind::Queues || kind == TrackKind::Value; }
std::string_view word_of(TrackKind kind);

struct TracksWanted {
  Time from = 0, to = 0;       ///< a part of the past, `from` before `to`
  std::size_t most = 2000;     ///< elements of a track
  std::size_t watched_at = 0;  ///< the station of `watched`
  std::vector<MemoryRange> watched{};
};

struct NamedTrack {
  TrackKind kind{};
  std::string name;  ///< `port 0 received`, `INT 123`, `VW20`
  std::size_t station = 0;
  std::optional<SerialFormat> format{};  ///< of characters: the one that the port had last
  Track track;
};

/// A frame that a PLC has received, and the one that it has sent next.
struct AnsweredFrame {
  std::size_t station = 0;
  Time at = 0, end = 0;  ///< of the frame received
  Time answer_at = 0, answer_end = 0;
  std::string text{};  ///< of the frame received, as in its track
  Time latency() const { return answer_at - end; }
};

/// The answers that came latest after their requests, the latest first; of equal ones the earlier first.
class LongestAnswers {
 public:
  static constexpr std::size_t kMost = 20;

  void add(AnsweredFrame answered);

  std::size_t count() const { return count_; }  ///< of all answers
  const std::vector<AnsweredFrame>& all() const { return all_; }

 private:
  std::size_t count_ = 0;
  std::vector<AnsweredFrame> all_{};
};

/// The longest scan of a PLC of those that have ended in the part; of equal ones the first.
struct LongestScan {
  std::size_t station = 0;
  Time at = 0, end = 0;
  std::string text{};  ///< as in its track
};

struct TracksOfPast {
  Time to = 0;  ///< the end of what was looked at: earlier than it was wanted after a stop request
  bool interrupted = false;
  bool with_networks = true;  ///< networks and routines were followed
  std::vector<NamedTrack> tracks{};
  LongestAnswers longest{};
  std::vector<LongestScan> longest_scans{};  ///< by station; none of one without a scan
};

/// Up to this length of a part networks and routines are followed, and every scan is seen; in a longer one scans that are
/// all alike are passed over, and count in the element of the last one before them.
inline constexpr Time kLongestWithNetworks = 10 * kSecond;

/// The simulation stands where it stood.
TracksOfPast tracks_of_past(History& history, const TracksWanted& wanted, StopToken stop_request);

}  // namespace s7200::tools
