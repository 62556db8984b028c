// Whoever waits for an analysis.
#pragma once

#include <functional>

#include "interpreter/base/stop_token.hpp"

namespace s7200 {

/// An analysis asks at each of its steps whether it is to end. What it has not looked at by then it does not know.
struct Waiter {
  StopToken stop{};
  std::function<void()> goes_on{};  ///< called at each step, to show progress; empty: nobody looks

  bool asks_to_end() const {
    if (goes_on) goes_on();
    return stop.stop_requested();
  }
};

}  // namespace s7200
