// Names for the numbers of the interrupt events (facts 3.1). Their queues, order and CPUs are in the list all_events().
#pragma once

#include <cstdint>

namespace s7200::event {

enum Number : std::uint8_t {
  kI00Rises = 0,
  kI00Falls = 1,
  kI01Rises = 2,
  kI01Falls = 3,
  kI02Rises = 4,
  kI02Falls = 5,
  kI03Rises = 6,
  kI03Falls = 7,
  kPort0Received = 8,
  kPort0Sent = 9,
  kTimed0 = 10,
  kTimed1 = 11,
  kCounter0Reached = 12,
  kCounter1Reached = 13,
  kCounter1Turned = 14,
  kCounter1Reset = 15,
  kCounter2Reached = 16,
  kCounter2Turned = 17,
  kCounter2Reset = 18,
  kPulses0Complete = 19,
  kPulses1Complete = 20,
  kT32Reached = 21,
  kT96Reached = 22,
  kPort0Message = 23,
  kPort1Message = 24,
  kPort1Received = 25,
  kPort1Sent = 26,
  kCounter0Turned = 27,
  kCounter0Reset = 28,
  kCounter4Reached = 29,
  kCounter4Turned = 30,
  kCounter4Reset = 31,
  kCounter3Reached = 32,
  kCounter5Reached = 33,
};

/// SMB34 and SMB35 say how often they come.
constexpr bool is_timed(std::uint8_t number) { return number == kTimed0 || number == kTimed1; }

}  // namespace s7200::event
