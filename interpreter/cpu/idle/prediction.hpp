// The shadow mode of scans that are passed over: a state that was predicted, instead of moving on to it, is compared with the one
// that the CPU comes to.
#pragma once

#include <cstdlib>
#include <memory>

#include "interpreter/cpu/core.hpp"

namespace s7200 {

/// Compares once the CPU has come so far. What has come from outside meanwhile ends the prediction.
inline void compare(const Core& core, std::unique_ptr<State>& expected) {
  if (!core.touched && core.s.time < expected->time) return;
  if (!core.touched && !(core.s == *expected))
    std::abort();  // a bug of ours: the prediction is not what the CPU does; also where assertions are off
  expected.reset();
}

}  // namespace s7200
