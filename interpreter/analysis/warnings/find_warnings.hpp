// The warnings that need the whole program.
#pragma once

#include "interpreter/analysis/waiter.hpp"
#include "interpreter/base/diagnostic.hpp"
#include "interpreter/program/program.hpp"

namespace s7200 {

/// Adds them, in no order. The program may have errors; then only a warning that holds in spite of what is unread is added.
/// If `waiter` asks to end, those that were found by then.
void find_warnings(const Program& program, stl::Diagnostics& diagnostics, const Waiter& waiter = {});

}  // namespace s7200
