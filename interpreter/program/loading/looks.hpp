// What a program looks at of the things that change by themselves. It is worked out once at load (analysis/effects/looks.hpp); the
// CPU passes over scans that are all alike only as far as none of these change (cpu/steady_scans.hpp).
#pragma once

#include <bitset>

#include "interpreter/model/area.hpp"

namespace s7200 {

struct Looks {
  bool clock_bits = false;  ///< SM0.4 or SM0.5, or something that holds them
  bool time_of_day = false;
  bool every_scan = false;  ///< the CPU's own milliseconds, by BITIM or CITIM; or every scan is wanted
  /// Timers of which every tick may matter: their value is read, something else writes them, or they are not certain to be
  /// executed exactly once in each scan. Of the others only the moment matters when they reach their preset.
  std::bitset<image::kTimers> every_tick;

  bool operator==(const Looks&) const = default;
};

}  // namespace s7200
