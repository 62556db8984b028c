// The commands and answers of measure_times.stl and their places in memory, byte by byte as in the head of the program.
#pragma once

#include <cstddef>
#include <cstdint>

#include "interpreter/base/time.hpp"

namespace s7200::tools::measuring {

/// The version of the commands' and answers' meaning; the program's answers name it.
inline constexpr std::uint8_t kVersion = 3;

inline constexpr std::uint8_t kCommandMark = 0x6D, kAnswerMark = 0x4D;

/// Places in an answer after its mark and the repeated part of the command.
inline constexpr std::size_t kMilliseconds = 6, kIdentification = 8, kVersionPlace = 9, kLoops = 10, kCheck = 11,
                             kAnswerLength = 13;

inline constexpr std::uint8_t kNoLoop = 255;

/// SMB34, in the loops that a timed interrupt takes time from.
inline constexpr Time kInterruptEvery = 5 * kMillisecond;

/// V memory: where a command comes to stand. M31.0: it is complete. VW10 counts the repetitions of a loop.
inline constexpr std::uint32_t kCommandAt = 20, kCompleteByte = 31, kCounterAt = 10;
inline constexpr std::uint8_t kCompleteBit = 1;

}  // namespace s7200::tools::measuring
