// What the protocol calls exceptions: an editor offers a filter for each.
#pragma once

#include <optional>
#include <string_view>

#include "tools/session/stops/stop_point.hpp"

namespace s7200::tools::dap {

struct ExceptionFilter {
  std::string_view id;
  const char* label;
  const char* description;
  std::optional<StopPoint::On> on;  ///< nothing: it ends every run by itself
  const char* name = "";            ///< of its stops
  std::string_view codes = "";      ///< that its condition is a list of, for people; empty: it has no condition
};

inline constexpr ExceptionFilter kExceptionFilters[] = {
    {"error", "Run-time errors", "Stops after the instruction that causes a run-time error", StopPoint::On::RuntimeError,
     "run-time error", "codes in hex: 0006, 0091"},
    {"overflow", "Queue overflow", "An interrupt is lost because its queue is full", StopPoint::On::QueueOverflow,
     "queue overflow"},
    {"lost", "Lost characters", "A character that the program does not get", StopPoint::On::LostCharacter, "lost character"},
    {"unanswered", "Unanswered requests", "A master, a bridge or a PLC has asked on a line of a PLC, and got no answer",
     StopPoint::On::Unanswered, "unanswered request"},
    {"wrong", "Wrong answers",
     "A master or a PLC has asked on a line of a PLC, and cannot take the answer: wrong parity or CRC, cut short",
     StopPoint::On::WrongAnswer, "wrong answer"},
    {"watchdog", "Watchdog and other fatal errors", "Stops in front of the instruction that ends in STOP", {}}};

}  // namespace s7200::tools::dap
