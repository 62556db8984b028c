#include "interpreter/program/checking/warnings.hpp"

#include <algorithm>
#include <array>

namespace s7200 {

std::span<const WarningInfo> all_warnings() {
  static constexpr std::array kTable{
      WarningInfo{Warning::ConstantContact, "constant-contact", "a contact of SM0.0, or a comparison, that never opens or never closes"},
      WarningInfo{Warning::DoubleCoil, "double-coil", "a coil that another one always overwrites"},
      WarningInfo{Warning::DoubleCounter, "double-counter", "a counter that counts twice in a scan"},
      WarningInfo{Warning::DoubleLoop, "double-loop", "two PIDs of the same loop"},
      WarningInfo{Warning::DoubleTimer, "double-timer", "a timer that is executed twice in a scan"},
      WarningInfo{Warning::LogicStack, "logic-stack", "a rung that leaves more than one value on the logic stack"},
      WarningInfo{Warning::LongInterrupt, "long-interrupt",
                  "a timed interrupt whose routine can take longer than its period"},
      WarningInfo{Warning::NeverTrue, "never-true", "a condition that needs what excludes each other"},
      WarningInfo{Warning::NoEni, "no-eni", "ATCH in a program without ENI: no interrupt is ever served"},
      WarningInfo{Warning::NoFreeport, "no-freeport",
                  "XMT before SMB30 is written, or XMT or port events in a program that never writes it"},
      WarningInfo{Warning::NoReceiveEvent, "no-receive-event",
                  "SMB2 or SM3.0 in a program that attaches nothing to event 8 or 25"},
      WarningInfo{Warning::OtherSign, "other-sign", "a constant whose bits the instruction reads with the other sign"},
      WarningInfo{Warning::Overwritten, "overwritten",
                  "a bit that is set, reset or written, and always overwritten before it is used"},
      WarningInfo{Warning::PortBusy, "port-busy", "XMT or RCV while the port is surely sending or receiving"},
      WarningInfo{Warning::Preset, "preset", "a constant preset of 0 or below: the timer or counter has nothing to count"},
      WarningInfo{Warning::ReceiveOnce, "receive-once", "RCV in the first scan, and nothing that executes one again"},
      WarningInfo{Warning::Recursion, "recursion", "a subroutine that calls itself, directly or through others"},
      WarningInfo{Warning::RepeatedEdge, "repeated-edge", "EU or ED in a loop, or in a subroutine that a scan calls twice"},
      WarningInfo{Warning::RestartedTimer, "restarted-timer",
                  "ATCH of a timed interrupt in every scan: it starts the period again"},
      WarningInfo{Warning::SkippedTimer, "skipped-timer", "a 100 ms timer that some scans leave out, or that a loop executes again"},
      WarningInfo{Warning::Unreachable, "unreachable", "an instruction that nothing leads to"},
      WarningInfo{Warning::UnreachedPreset, "unreached-preset",
                  "a counter that is reset below its preset, and whose bit a contact looks at"},
      WarningInfo{Warning::UnusedFreeport, "unused-freeport",
                  "a port in Freeport mode without XMT, RCV and an interrupt for its characters"},
      WarningInfo{Warning::UnusedLabel, "unused-label", "a label that no JMP goes to"},
      WarningInfo{Warning::UnusedRoutine, "unused-routine", "a routine that is never called or attached"},
      WarningInfo{Warning::UnusedSpecialMemory, "unused-sm",
                  "special memory that the CPU makes no use of, or a word over a byte of it"},
      WarningInfo{Warning::UnusedStep, "unused-step", "an S bit that is set but that no segment and no contact loads"},
  };
  return kTable;
}

stl::Diagnostic warn(Warning warning, const stl::Position& at, std::string message, std::string hint, std::string cause) {
  const auto row = std::ranges::find(all_warnings(), warning, &WarningInfo::warning);
  return {stl::Severity::Warning, at, std::move(message), std::move(hint), std::move(cause), std::string(row->name)};
}

}  // namespace s7200
