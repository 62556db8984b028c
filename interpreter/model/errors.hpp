// Codes of the errors that the simulated CPU can report, and their meanings.
#pragma once

#include <cstdint>
#include <string_view>

namespace s7200 {

/// Run-time errors: SM4.3 becomes 1 and the program goes on (facts 5.2).
enum class RunError : std::uint16_t {
  CounterNotDefined = 0x01,
  PointTaken = 0x02,
  InputTaken = 0x03,
  NotInInterrupt = 0x04,
  IndirectAddress = 0x06,
  Clock = 0x07,
  CallDepth = 0x08,
  Port0Busy = 0x09,
  CounterDefinedTwice = 0x0A,
  Port1Busy = 0x0B,
  NoSegments = 0x0E,
  CompareValue = 0x0F,
  PidTable = 0x13,
  OperandRange = 0x91,
  Count = 0x92,
  EepromRange = 0x94,
  FreeportInInterrupt = 0x9A,
  StringIndex = 0x9B,
};

/// Fatal errors: the CPU goes to STOP (facts 5.1).
enum class FatalError : std::uint16_t { Watchdog = 0x03, CompareIndirect = 0x11, CompareValue = 0x12, CompareRange = 0x14 };

/// The error of a NETR or NETW, in the low bits of the status in its table (facts 10.9).
enum class NetworkError : std::uint8_t {
  None,
  TimeOut,
  Damaged,  ///< parity, framing or check sum of the answer
  Offline,
  Overflow,    ///< a ninth job
  NotMaster,   ///< the port is not in PPI master mode
  Parameter,   ///< a value in the table
  NoResource,  ///< the station is busy with another master
  Layer7,      ///< the station does not understand the request, or its answer is not understood
  Message,     ///< the station does not have these data
};

/// The status in the table of a NETR or NETW.
enum NetworkStatus : std::uint8_t { kJobDone = 0x80, kJobActive = 0x40, kJobError = 0x20, kJobErrorCode = 0x0F };

/// The meaning of a code, in one line.
std::string_view meaning_of(RunError code);
std::string_view meaning_of(FatalError code);
std::string_view meaning_of(NetworkError code);

}  // namespace s7200
