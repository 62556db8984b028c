// A track of a timeline: what was so from one instant to another, and no more of it than can be shown.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "interpreter/base/time.hpp"

namespace s7200::tools {

/// An element of a track, or several that begin in the same part of the time.
struct TrackSpan {
  Time at = 0, end = 0;               ///< of several the start of the first and the end of the last
  std::string text{};                 ///< in words; of several that of the first
  std::string error{};                ///< what is wrong with it; of several that of the first with an error
  std::string why{};                  ///< what an interrupt waited for
  std::optional<double> value{};      ///< of a watched address; of several the last one
  double least = 0, most = 0;         ///< of several values
  std::optional<Time> occurred{};     ///< of an interrupt: when its event occurred
  std::optional<std::uint32_t> op{};  ///< the instruction that it is about
  std::uint64_t count = 1;            ///< how many are in one
  Time busy = 0;                      ///< the sum of their lengths
  std::uint64_t errors = 0;           ///< how many of them have an error
};

/// Elements one by one as long as there are at most `most`. Of more, all that begin in the same `most`th part of the time
/// are one: nothing is left out, an error can be seen however long the time is.
class Track {
 public:
  /// `from` is before `to`, `most` is above 0.
  Track(Time from, Time to, std::size_t most);

  /// Elements come in the order of their starts. `busy` and `errors` of an element are worked out here.
  void add(TrackSpan span);

  const std::vector<TrackSpan>& spans() const { return spans_; }
  /// Whether each element is a single one.
  bool is_exact() const { return exact_; }

 private:
  void put(TrackSpan span);
  void join_all();

  Time from_;
  std::size_t most_;
  Time part_;
  bool exact_ = true;
  std::vector<TrackSpan> spans_{};
};

}  // namespace s7200::tools
