// What a check warns about: programs that are legal and that the CPU runs, but probably not as intended.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "interpreter/base/diagnostic.hpp"

namespace s7200 {

enum class Warning : std::uint8_t {
  ConstantContact,
  DoubleCoil,
  DoubleTimer,
  DoubleCounter,
  DoubleLoop,
  LogicStack,
  LongInterrupt,
  NeverTrue,
  NoEni,
  NoFreeport,
  NoReceiveEvent,
  OtherSign,
  Overwritten,
  PortBusy,
  Preset,
  ReceiveOnce,
  Recursion,
  RepeatedEdge,
  RestartedTimer,
  SkippedTimer,
  Unreachable,
  UnreachedPreset,
  UnusedFreeport,
  UnusedLabel,
  UnusedRoutine,
  UnusedSpecialMemory,
  UnusedStep,
};

struct WarningInfo {
  Warning warning;
  std::string_view name;     ///< the name that switches it off
  std::string_view meaning;  ///< one line
};

/// The table of warnings, in the order of their names.
std::span<const WarningInfo> all_warnings();

stl::Diagnostic warn(Warning warning, const stl::Position& at, std::string message, std::string hint = {},
                     std::string cause = {});

}  // namespace s7200
