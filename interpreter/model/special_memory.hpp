// Special memory by name: where its bytes are in the image, and what their bits mean (facts 2.1, 4.3–4.5).
//
// Which bytes a program may use, and which are modelled, is in the list special_memory() (cpu_model.hpp).
#pragma once

#include <array>
#include <cstdint>

#include "interpreter/model/area.hpp"

namespace s7200 {

/// Bits of SM1 that an instruction sets and resets (S7-200 manual C230-02, D-2).
enum Flag : std::uint8_t {
  kZero = 1,
  kOverflow = 2,
  kNegative = 4,
  kDivisionByZero = 8,
  kTableFull = 16,
  kTableEmpty = 32,
  kNotBcd = 64,
  kNotHex = 128
};

/// Flags that say that an instruction has not done what it should; of shifts, kOverflow is the last bit shifted out.
inline constexpr std::uint8_t kFailures = kOverflow | kDivisionByZero | kTableFull | kTableEmpty | kNotBcd | kNotHex;

namespace sm {

constexpr std::uint32_t byte(std::uint32_t number) { return image::kSM + number; }

inline constexpr std::uint32_t kScanStatus = byte(0);
enum ScanStatus : std::uint8_t {
  kAlwaysOn = 0x01,         ///< SM0.0
  kFirstScan = 0x02,        ///< SM0.1
  kRetentiveLost = 0x04,    ///< SM0.2: for one scan, if retentive data were lost
  kFromPowerUp = 0x08,      ///< SM0.3: for one scan, if RUN was entered from power-up
  kClock1min = 0x10,        ///< SM0.4: 30 s on, 30 s off
  kClock1s = 0x20,          ///< SM0.5: 0.5 s on, 0.5 s off
  kAlternatingScan = 0x40,  ///< SM0.6
  kModeSwitchRun = 0x80,    ///< SM0.7: mode switch in RUN; 0: in TERM
};

inline constexpr std::uint32_t kFlags = byte(1);  ///< bits of Flag

inline constexpr std::uint32_t kReceivedCharacter = byte(2);  ///< of any port, for its interrupt routine
inline constexpr std::uint32_t kReceiveStatus = byte(3);
enum ReceiveStatus : std::uint8_t { kParityError = 0x01 };  ///< SM3.0

inline constexpr std::uint32_t kInterruptStatus = byte(4);
enum InterruptStatus : std::uint8_t {
  kQueueOverflow = 0x07,      ///< SM4.0 communication, SM4.1 I/O, SM4.2 timed: in the order of the queues
  kRuntimeError = 0x08,       ///< SM4.3
  kInterruptsEnabled = 0x10,  ///< SM4.4
  kPort0Idle = 0x20,          ///< SM4.5: transmitter idle
  kPort1Idle = 0x40,          ///< SM4.6
  kForced = 0x80,             ///< SM4.7 of a CPU 22x: something is forced
};

inline constexpr std::uint32_t kIdentification = byte(6);
/// Of expansion modules 0 to 6: bits M t t A i i Q Q (facts 10.5).
/// Not documented, modelled so: no module tells its identity: M is 1, all else 0.
/// [Choices.NoExpansionModuleTellsItsIdentity]
inline constexpr std::array<std::uint32_t, 7> kModuleIdentity{byte(8),  byte(10), byte(12), byte(14),
                                                              byte(16), byte(18), byte(20)};
enum ModuleIdentity : std::uint8_t { kNoModule = 0x80 };  ///< M: no module is there

inline constexpr std::uint32_t kLastScan = byte(22), kShortestScan = byte(24), kLongestScan = byte(26);  ///< words, in ms
inline constexpr std::array<std::uint32_t, 2> kPotentiometer{byte(28), byte(29)};

/// Fields of a port's control byte: p p d b b b m m. Where it is, is in the row of the port (ports.hpp).
enum PortControl : std::uint8_t {
  kProtocol = 0x03,  ///< mm
  kFreeport = 0x01,  ///< as the protocol
  kPpiMaster = 0x02,
  kBaudRate = 0x1C,   ///< bbb
  kSevenBits = 0x20,  ///< d: characters of 7 bits; otherwise 8
  kParity = 0xC0,     ///< pp
};

inline constexpr std::uint32_t kEepromRequest = byte(31);
enum EepromRequest : std::uint8_t {
  kSaveSize = 0x03,  ///< SM31.0, SM31.1: 2 a word, 3 a double word, otherwise a byte
  kSave = 0x80,      ///< SM31.7
};
inline constexpr std::uint32_t kEepromAddress = byte(32);  ///< word: offset in V

inline constexpr std::array<std::uint32_t, 2> kTimedInterval{byte(34), byte(35)};  ///< of events 10 and 11, in ms

}  // namespace sm

/// The receive message service of a port, nine bytes: SMB86 to SMB94 for port 0. Where they are, is in the row of the port.
namespace sm::message {

enum Status : std::uint8_t {  // n r e 0 0 t c p: why it has ended; 0 while it receives
  kParity = 0x01,             ///< a character with an error, or a break
  kCount = 0x02,              ///< as many characters as asked for
  kTimer = 0x04,              ///< the time has passed
  kEndCharacter = 0x20,
  kParameters = 0x40,  ///< no start condition, or no room
  kUser = 0x80,        ///< RCV with kEnable = 0
};

// Offsets from the status byte.
inline constexpr std::uint32_t kControl = 1;
inline constexpr std::uint32_t kStartCharacter = 2, kEndOfMessage = 3;
inline constexpr std::uint32_t kIdleTime = 4;  ///< word, in ms
inline constexpr std::uint32_t kTimeout = 6;   ///< word, in ms
inline constexpr std::uint32_t kMost = 8;      ///< characters

enum Control : std::uint8_t {  // en sc ec il c/m tmr bk 0
  kFromBreak = 0x02,
  kTimed = 0x04,
  kWholeMessage = 0x08,  ///< the time is that of the message; otherwise from one character to the next
  kFromIdleLine = 0x10,
  kHasEnd = 0x20,
  kFromStart = 0x40,
  kEnable = 0x80,
};

}  // namespace sm::message

/// High-speed counters, ten bytes each. Where they are, is in the row of the counter (counters.hpp).
namespace sm::counter {

enum Status : std::uint8_t { kCountingUp = 0x20, kAtPreset = 0x40, kAbovePreset = 0x80 };

// Offsets from the status byte.
inline constexpr std::uint32_t kControl = 1;
inline constexpr std::uint32_t kNewCurrent = 2;  ///< double word
inline constexpr std::uint32_t kNewPreset = 6;   ///< double word

enum Control : std::uint8_t {
  kResetLow = 0x01,
  kStartLow = 0x02,
  kSingleRate = 0x04,
  kUp = 0x08,
  kTakeDirection = 0x10,
  kTakePreset = 0x20,
  kTakeCurrent = 0x40,
  kEnable = 0x80,
};

}  // namespace sm::counter

/// Pulse outputs Q0.0 and Q0.1, ten bytes each, and what belongs to their profiles.
namespace sm::pulses {

inline constexpr std::array<std::uint32_t, 2> kStatus{byte(66), byte(76)};
inline constexpr std::array<std::uint32_t, 2> kSegment{byte(166), byte(176)};       ///< number of the one in progress
inline constexpr std::array<std::uint32_t, 2> kProfileTable{byte(168), byte(178)};  ///< word: offset in V
/// SMB166 to SMB185, all that profiles have here, of both outputs (facts 10.4).
inline constexpr std::uint32_t kProfiles = byte(166), kProfilesBytes = 20;
inline constexpr std::uint32_t kSegmentBytes = 8;  ///< of a profile; in front of the first is their number, a byte
enum Status : std::uint8_t {
  kDeltaError = 0x10,  ///< a segment of the profile would have left the range of cycle times
  kUserAbort = 0x20,   ///< PLS has ended a profile
  kTrainOverflow = 0x40,
  kIdle = 0x80
};

// Offsets from the status byte.
inline constexpr std::uint32_t kControl = 1;
inline constexpr std::uint32_t kCycleTime = 2;   ///< word
inline constexpr std::uint32_t kPulseWidth = 4;  ///< word
inline constexpr std::uint32_t kPulseCount = 6;  ///< double word

enum Control : std::uint8_t {
  kTakeCycle = 0x01,
  kTakeWidth = 0x02,
  kTakeCount = 0x04,
  kMilliseconds = 0x08,
  kSynchronous = 0x10,  ///< PWM: a change waits for the end of the cycle
  kProfile = 0x20,      ///< PTO: several segments, from a table in V memory
  kPwm = 0x40,
  kEnable = 0x80,
};

}  // namespace sm::pulses
}  // namespace s7200
