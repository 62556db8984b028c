#include "interpreter/model/special_bits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "interpreter/model/counters.hpp"
#include "interpreter/model/ports.hpp"
#include "interpreter/model/special_memory.hpp"

namespace s7200 {
namespace {

constexpr SpecialBit kScanStatusBits[]{{sm::kAlwaysOn, "always 1"},
                                       {sm::kFirstScan, "first scan"},
                                       {sm::kRetentiveLost, "retentive data lost"},
                                       {sm::kFromPowerUp, "first scan after power-up"},
                                       {sm::kClock1min, "clock of 1 min"},
                                       {sm::kClock1s, "clock of 1 s"},
                                       {sm::kAlternatingScan, "clock of a scan"},
                                       {sm::kModeSwitchRun, "mode switch in RUN"}};

constexpr SpecialBit kFlagBits[]{{kZero, "zero"},
                                 {kOverflow, "overflow"},
                                 {kNegative, "negative"},
                                 {kDivisionByZero, "division by zero"},
                                 {kTableFull, "table full"},
                                 {kTableEmpty, "table empty"},
                                 {kNotBcd, "not BCD"},
                                 {kNotHex, "not hex"}};

constexpr SpecialBit kReceiveBits[]{{sm::kParityError, "parity error"}};

constexpr SpecialBit kInterruptBits[]{{0x01, "communication queue overflow"},
                                      {0x02, "input/output queue overflow"},
                                      {0x04, "timed queue overflow"},
                                      {sm::kRuntimeError, "run-time error"},
                                      {sm::kInterruptsEnabled, "interrupts enabled"},
                                      {sm::kPort0Idle, "transmitter of port 0 idle"},
                                      {sm::kPort1Idle, "transmitter of port 1 idle"},
                                      {sm::kForced, "something is forced"}};

constexpr SpecialBit kEepromBits[]{{0x01, "size, low bit"}, {0x02, "size, high bit"}, {sm::kSave, "save a value to EEPROM"}};

constexpr SpecialBit kMessageStatusBits[]{
    {sm::message::kUser, "ended by the program"},  {sm::message::kParameters, "no start condition or no room"},
    {sm::message::kEndCharacter, "end character"}, {sm::message::kTimer, "the time has passed"},
    {sm::message::kCount, "as many as can be"},    {sm::message::kParity, "a bad character"}};

constexpr SpecialBit kMessageControlBits[]{{sm::message::kEnable, "enabled"},
                                           {sm::message::kFromStart, "start character"},
                                           {sm::message::kHasEnd, "end character"},
                                           {sm::message::kFromIdleLine, "idle line"},
                                           {sm::message::kWholeMessage, "timer of the whole message"},
                                           {sm::message::kTimed, "timer"},
                                           {sm::message::kFromBreak, "break"}};

constexpr SpecialBit kCounterStatusBits[]{{sm::counter::kCountingUp, "counting up"},
                                          {sm::counter::kAtPreset, "current = preset"},
                                          {sm::counter::kAbovePreset, "current > preset"}};

constexpr SpecialBit kCounterControlBits[]{
    {sm::counter::kResetLow, "reset active low"},          {sm::counter::kStartLow, "start active low"},
    {sm::counter::kSingleRate, "counts once a period"},    {sm::counter::kUp, "up"},
    {sm::counter::kTakeDirection, "take the direction"},   {sm::counter::kTakePreset, "take the preset"},
    {sm::counter::kTakeCurrent, "take the current value"}, {sm::counter::kEnable, "enabled"}};

constexpr SpecialBit kPulseStatusBits[]{{sm::pulses::kDeltaError, "profile: error of a delta"},
                                        {sm::pulses::kUserAbort, "profile: ended by the program"},
                                        {sm::pulses::kTrainOverflow, "queue of pulse trains overflowed"},
                                        {sm::pulses::kIdle, "idle"}};

constexpr SpecialBit kPulseControlBits[]{{sm::pulses::kTakeCycle, "take the cycle time"},
                                         {sm::pulses::kTakeWidth, "take the pulse width"},
                                         {sm::pulses::kTakeCount, "take the pulse count"},
                                         {sm::pulses::kMilliseconds, "in ms"},
                                         {sm::pulses::kSynchronous, "synchronous"},
                                         {sm::pulses::kProfile, "several segments"},
                                         {sm::pulses::kPwm, "PWM"},
                                         {sm::pulses::kEnable, "enabled"}};

/// Joins `named(bit)` of the bits that are set with commas.
template <class Named>
std::string set_bits(std::uint32_t at, std::uint8_t value, const Named& named) {
  std::string text;
  for (const SpecialBit& bit : special_bits(at))
    if (value & bit.mask) text += (text.empty() ? "" : ", ") + named(bit);
  return text;
}

}  // namespace

std::span<const SpecialBit> special_bits(std::uint32_t at) {
  if (at == sm::kScanStatus) return kScanStatusBits;
  if (at == sm::kFlags) return kFlagBits;
  if (at == sm::kReceiveStatus) return kReceiveBits;
  if (at == sm::kInterruptStatus) return kInterruptBits;
  if (at == sm::kEepromRequest) return kEepromBits;
  for (const PortInfo& port : kPorts) {
    if (at == port.message) return kMessageStatusBits;
    if (at == port.message + sm::message::kControl) return kMessageControlBits;
  }
  for (const CounterInfo& counter : kCounters) {
    if (at == counter.status) return kCounterStatusBits;
    if (at == counter.status + sm::counter::kControl) return kCounterControlBits;
  }
  for (const std::uint32_t status : sm::pulses::kStatus) {
    if (at == status) return kPulseStatusBits;
    if (at == status + sm::pulses::kControl) return kPulseControlBits;
  }
  return {};
}

std::string special_bits_text(std::uint32_t at, std::uint8_t value) {
  return set_bits(at, value, [at](const SpecialBit& bit) {
    return fmt::format("SM{}.{} {}", at - image::kSM, std::countr_zero(bit.mask), bit.meaning);
  });
}

std::string special_meanings_text(std::uint32_t at, std::uint8_t value) {
  return set_bits(at, value, [](const SpecialBit& bit) { return std::string(bit.meaning); });
}

}  // namespace s7200
