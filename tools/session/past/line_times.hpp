// How long it may be quiet on a line. What a port hears as one frame ends after SerialFormat::silence().
#pragma once

#include "interpreter/base/time.hpp"

namespace s7200::tools {

/// A host hands what it sends to the serial port in pieces, which follow each other so soon.
inline constexpr Time kNextPiece = 100 * kMillisecond;

/// So long an exchange that is over is still the last one on its line.
inline constexpr Time kJustOver = 100 * kMillisecond;

}  // namespace s7200::tools
