// Which contacts hold a bit off, or on, and who could change them.
//
// Works on the rungs that write it (interpreter/analysis/flow/ways.hpp) and on what their contacts have: as the program last
// found them, or as a memory picture has them. Followed further a few levels: to an input, a timer, a counter, a step of a
// sequence, a message, an interrupt.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/result.hpp"
#include "interpreter/base/stop_token.hpp"
#include "tools/session/causes/expression.hpp"
#include "tools/session/causes/obstacle.hpp"
#include "tools/session/past/history.hpp"

namespace s7200::tools {

/// What is wished for: that a bit is on or off, or that an expression holds.
struct Wish {
  std::string text{};                     ///< as it was written
  std::optional<Bits> bit{};              ///< the bit of a timer or counter, too
  bool on = true;                         ///< of the bit
  std::optional<Expression> condition{};  ///< without a bit
};

/// `Q0.3`, `not Q0.3`, `T37`, `VW10 > 5`. Trouble if it cannot be read.
Result<Wish> parse_wish(std::string_view text, const Program& program);

/// The bits that it is about, without those that pointers lead to.
std::vector<Bits> bits_of(const Wish& wish);

/// Whether it is so now; trouble where a pointer points nowhere.
Result<bool> holds_now(const Wish& wish, const Cpu& cpu);

/// What is in the way where the history stands, which stands there afterwards; with since when each value has been there, to
/// the scan. Nothing after a stop request.
std::optional<Obstacle> why_not(History& history, std::size_t station, const Wish& wish, StopToken stop_request);

/// The same from the state of a CPU alone, of which nothing has run.
Obstacle why_not(const Cpu& cpu, const Wish& wish);

/// From the state of a CPU alone: what keeps a bit as it is, on or off, whatever is wished; of an expression the same as
/// why_not().
Obstacle what_keeps(const Cpu& cpu, const Wish& wish);

}  // namespace s7200::tools
