#include "interpreter/model/errors.hpp"

namespace s7200 {

std::string_view meaning_of(RunError code) {
  switch (code) {
    case RunError::CounterNotDefined:
      return "HSC before HDEF for the same counter";
    case RunError::PointTaken:
      return "input interrupt attached to a point that a high-speed counter uses";
    case RunError::InputTaken:
      return "HDEF uses an input that an input interrupt is attached to, or another high-speed counter uses";
    case RunError::NotInInterrupt:
      return "instruction that an interrupt routine must not execute";
    case RunError::Clock:
      return "TODW: the buffer does not hold BCD";
    case RunError::CounterDefinedTwice:
      return "second HDEF for the same counter";
    case RunError::CompareValue:
      return "illegal value in a compare contact: not a real number (NaN)";
    case RunError::PidTable:
      return "PID: the loop table asks for auto-tuning, which is not modelled";
    case RunError::EepromRange:
      return "the V address to save is outside the EEPROM";
    case RunError::IndirectAddress:
      return "indirect addressing error: the pointer points outside the memory that it may reach";
    case RunError::CallDepth:
      return "subroutines nested too deeply";
    case RunError::Port0Busy:
      return "XMT or RCV while port 0 is sending or receiving a message, or is not in Freeport mode";
    case RunError::Port1Busy:
      return "XMT or RCV while port 1 is sending or receiving a message, or is not in Freeport mode";
    case RunError::NoSegments:
      return "PLS: the profile has no segments";
    case RunError::OperandRange:
      return "range error: the operand runs past the end of its memory area";
    case RunError::Count:
      return "error in the count field of an instruction";
    case RunError::FreeportInInterrupt:
      return "attempt to switch to Freeport in an interrupt routine";
    case RunError::StringIndex:
      return "illegal string index: the characters of a string are numbered from 1";
  }
  return "unknown";
}

std::string_view meaning_of(FatalError code) {
  switch (code) {
    case FatalError::Watchdog:
      return "scan watchdog: the scan took longer than 300 ms (CPU 22x of release 2: 500 ms) without WDR";
    case FatalError::CompareIndirect:
      return "indirect addressing error in a compare contact";
    case FatalError::CompareRange:
      return "range error in a compare contact: the string runs past the end of its memory area";
    case FatalError::CompareValue:
      return "illegal value in a compare contact: not a real number (NaN)";
  }
  return "unknown";
}

std::string_view meaning_of(NetworkError code) {
  switch (code) {
    case NetworkError::None:
      return "done";
    case NetworkError::TimeOut:
      return "the station does not answer";
    case NetworkError::Damaged:
      return "the answer is damaged";
    case NetworkError::Offline:
      return "the port is not on the line";
    case NetworkError::Overflow:
      return "eight jobs are on the list already";
    case NetworkError::NotMaster:
      return "the port is not in PPI master mode";
    case NetworkError::Parameter:
      return "a value in the table is not allowed";
    case NetworkError::NoResource:
      return "the station is busy with another master";
    case NetworkError::Layer7:
      return "the request or its answer is not understood";
    case NetworkError::Message:
      return "the station has no such data";
  }
  return "unknown";
}

}  // namespace s7200
