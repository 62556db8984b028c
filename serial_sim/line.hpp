// The two wires of an RS-485 line, as a level over time.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "interpreter/base/time.hpp"

namespace s7200::serial {

/// Each driver holds the line at mark (true, the idle level) or space (false). A driver that marks is as good as one that
/// is switched off: the line is at space while any driver is. Two senders at once collide bit by bit.
/// Not documented, modelled so: on a real RS-485 line two active drivers that disagree give no defined level.
class Line {
 public:
  static constexpr int kDrivers = 4;

  /// From `at` on driver `driver` holds `mark`. `at` is not before that driver's last edge; it may lie in the future.
  void drive(int driver, Time at, bool mark);

  /// The level at an instant; an edge counts from its own instant on.
  bool level(Time at) const;

  /// First change from mark to space at or after `from` among the edges known now; kNever when there is none.
  Time falling_edge(Time from) const;

  /// Nobody will ask about the time before `before` again.
  void forget(Time before);

  bool operator==(const Line&) const = default;

 private:
  struct Edge {
    Time at = 0;
    bool mark = true;
    bool operator==(const Edge&) const = default;
  };
  struct Driver {
    bool mark_before = true;   // level ahead of the first edge kept
    std::vector<Edge> edges;   // in order of time
    bool operator==(const Driver&) const = default;
  };
  std::array<Driver, kDrivers> drivers_;
};

}  // namespace s7200::serial
