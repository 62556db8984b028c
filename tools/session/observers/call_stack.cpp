#include "tools/session/observers/call_stack.hpp"

#include <algorithm>

namespace s7200::tools {
namespace {

std::array<std::uint8_t, 16> accumulators_in(const State& state) {
  std::array<std::uint8_t, 16> accumulators{};
  std::copy_n(state.image.begin() + image::kAC, accumulators.size(), accumulators.begin());
  return accumulators;
}

}  // namespace

std::vector<OpenRoutine> open_routines(const State& state) {
  if (state.mode == Mode::Stop) return {};
  std::vector<OpenRoutine> open{
      {.op = standing_at(state).value_or(0), .stack = state.stack, .accumulators = accumulators_in(state)}};
  const auto add_callers = [&](std::size_t from, std::size_t to) {
    for (std::size_t depth = from; depth > to; --depth)
      open.push_back({.op = state.calls[depth - 1].return_to - 1,
                      .stack = state.calls[depth - 1].stack,
                      .accumulators = open.back().accumulators,
                      .interrupted = open.back().interrupted});
  };
  if (!state.in_interrupt) {
    add_callers(state.call_depth, 0);
    return open;
  }
  add_callers(state.call_depth, state.saved.call_depth);
  open.back().event = state.serving_event;
  open.back().since = state.serving_since;
  if (state.phase != Phase::Program) return open;
  open.push_back({.op = state.saved.return_to,
                  .stack = state.saved.stack,
                  .accumulators = state.saved.accumulators,
                  .interrupted = true});
  add_callers(state.saved.call_depth, 0);
  return open;
}

}  // namespace s7200::tools
