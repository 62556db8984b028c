// The high-speed counters, as data: their special memory, inputs and events (facts 10.4). Which of them a CPU has, and in
// which modes, is in its model.
#pragma once

#include <array>
#include <cstdint>

#include "interpreter/model/events.hpp"
#include "interpreter/model/special_memory.hpp"

namespace s7200 {

inline constexpr std::uint8_t kNoPoint = 0xFF, kNoEvent = 0xFF;

struct CounterInfo {
  std::uint32_t status;                         ///< place of its status byte in the image
  std::uint8_t clock, direction, reset, start;  ///< input points, as byte * 8 + bit; the second clock is at `direction`
  std::uint8_t reached, turned, was_reset;      ///< events
  std::uint8_t pulse_output = kNoPoint;         ///< whose pulses it counts in mode 12
};

// clang-format off

/// The high-speed counters, by number.
inline constexpr std::array<CounterInfo, 6> kCounters{{
    // I0.0, I0.1, I0.2
    {sm::byte(36),   0,        1,        2, kNoPoint, event::kCounter0Reached, event::kCounter0Turned, event::kCounter0Reset, 0},
    // I0.6, I0.7, I1.0, I1.1
    {sm::byte(46),   6,        7,        8,        9, event::kCounter1Reached, event::kCounter1Turned, event::kCounter1Reset},
    // I1.2, I1.3, I1.4, I1.5
    {sm::byte(56),  10,       11,       12,       13, event::kCounter2Reached, event::kCounter2Turned, event::kCounter2Reset},
    // I0.1
    {sm::byte(136),  1, kNoPoint, kNoPoint, kNoPoint, event::kCounter3Reached, kNoEvent,               kNoEvent,              1},
    // I0.3, I0.4, I0.5
    {sm::byte(146),  3,        4,        5, kNoPoint, event::kCounter4Reached, event::kCounter4Turned, event::kCounter4Reset},
    // I0.4
    {sm::byte(156),  4, kNoPoint, kNoPoint, kNoPoint, event::kCounter5Reached, kNoEvent,               kNoEvent},
}};

// clang-format on

/// The modes that a counter has, as a set of bits: mode 3 is bit 3. Without modes the CPU does not have the counter.
using CounterModes = std::uint16_t;
inline constexpr CounterModes kMode0 = 0x001, kAllModes = 0xFFF, kMode12 = 0x1000;
inline constexpr std::uint8_t kLastMode = 12;              ///< of CPUs 22x (facts 10.4)
inline constexpr CounterModes kModesWithoutStart = 0x6DB;  ///< 0 1 3 4 6 7 9 10

constexpr bool has_reset(std::uint8_t mode) { return mode % 3 != 0; }
constexpr bool has_start(std::uint8_t mode) { return mode % 3 == 2; }

/// The clocks of a mode do this.
enum class Clocking : std::uint8_t { InternalDirection, DirectionInput, UpAndDown, Quadrature, PulseOutput };
constexpr Clocking clocking(std::uint8_t mode) { return static_cast<Clocking>(mode / 3); }

/// The input points that a counter uses in a mode, as a set of bits: I0.0 is bit 0, I1.0 bit 8.
constexpr std::uint32_t points_of(const CounterInfo& counter, std::uint8_t mode) {
  const auto point = [](std::uint8_t number) { return number == kNoPoint ? 0u : 1u << number; };
  if (clocking(mode) == Clocking::PulseOutput) return 0;
  std::uint32_t points = point(counter.clock);
  if (clocking(mode) != Clocking::InternalDirection) points |= point(counter.direction);
  if (has_reset(mode)) points |= point(counter.reset);
  if (has_start(mode)) points |= point(counter.start);
  return points;
}

}  // namespace s7200
