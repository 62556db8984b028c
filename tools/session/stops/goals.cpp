#include "tools/session/stops/goals.hpp"

#include <optional>

namespace s7200::tools::goal {

using Progress = Stepper::Progress;

namespace {

bool is_interrupt_head(const Program& program, std::uint32_t op) {
  return program.ops[op].instruction->structure == Structure::InterruptHead;
}

/// In the interrupt that has been served since then, or in none.
bool is_same_level(const State& state, bool in_interrupt, Time since) {
  return state.in_interrupt == in_interrupt && (!in_interrupt || state.serving_since == since);
}

}  // namespace

Stepper::Goal none() { return {}; }

Stepper::Goal instructions(std::uint64_t count) {
  return [count](const State&, std::uint32_t, const Progress& progress) { return progress.executed >= count; };
}

Stepper::Goal over(const State& now) {
  return [in_interrupt = now.in_interrupt, since = now.serving_since, depth = now.call_depth](
             const State& state, std::uint32_t, const Progress& progress) {
    if (!progress.left || progress.executed == 0) return false;
    if (in_interrupt && !state.in_interrupt) return true;
    return is_same_level(state, in_interrupt, since) && state.call_depth <= depth;
  };
}

bool is_in_routine(const State& now) { return now.in_interrupt || now.call_depth > 0; }

Stepper::Goal out(const State& now) {
  return [in_interrupt = now.in_interrupt, since = now.serving_since, depth = now.call_depth](
             const State& state, std::uint32_t, const Progress&) {
    if (in_interrupt && !state.in_interrupt) return true;
    return is_same_level(state, in_interrupt, since) && state.call_depth < depth;
  };
}

Stepper::Goal scan(const State& now, std::uint64_t count) {
  return [target = now.scans + count](const State& state, std::uint32_t, const Progress&) {
    return state.scans >= target && !state.in_interrupt;
  };
}

Stepper::Goal place(std::uint32_t op) {
  return [op](const State&, std::uint32_t at, const Progress& progress) { return at == op && progress.left; };
}

Stepper::Goal network_over(const State& now, const Listing& listing) {
  return [&listing, at_same_level = over(now)](const State& state, std::uint32_t op, const Progress& progress) {
    return listing.begins_network(op) && at_same_level(state, op, progress);
  };
}

Stepper::Goal network_into(const Listing& listing) {
  return [&listing](const State&, std::uint32_t op, const Progress& progress) {
    return progress.executed > 0 && listing.begins_network(op);
  };
}

Stepper::Goal interrupt_begins(const Program& program) {
  return [&program](const State&, std::uint32_t op, const Progress& progress) {
    return progress.executed > 0 && is_interrupt_head(program, op);
  };
}

Stepper::Goal interrupt_ends(const State& now) {
  return [inside = now.in_interrupt, since = now.serving_since](const State& state, std::uint32_t, const Progress&) mutable {
    const bool ended = inside && (!state.in_interrupt || state.serving_since != since);
    inside = state.in_interrupt;
    since = state.serving_since;
    return ended;
  };
}

Stepper::Goal back_instruction() {
  return [](const State&, std::uint32_t, const Progress&) { return true; };
}

Stepper::Goal back_over(const State& now) {
  return [in_interrupt = now.in_interrupt, since = now.serving_since, depth = now.call_depth](
             const State& state, std::uint32_t, const Progress&) {
    if (state.in_interrupt) return in_interrupt && state.serving_since == since && state.call_depth <= depth;
    return in_interrupt || state.call_depth <= depth;
  };
}

Stepper::Goal back_out(const State& now) {
  const bool in_subroutine = now.call_depth > (now.in_interrupt ? now.saved.call_depth : 0);
  return [in_interrupt = now.in_interrupt && !in_subroutine, since = now.serving_since, in_any = now.in_interrupt,
          depth = now.call_depth](const State& state, std::uint32_t, const Progress&) {
    if (in_interrupt) return !state.in_interrupt;
    return is_same_level(state, in_any, since) && state.call_depth < depth;
  };
}

Stepper::Goal back_scan() {
  return [seen = std::optional<std::uint64_t>()](const State& state, std::uint32_t op, const Progress&) mutable {
    if (state.in_interrupt) return false;
    const bool begins = seen && *seen <= state.scans ? *seen != state.scans : op == 0;
    seen = state.scans;
    return begins;
  };
}

Stepper::Goal back_network_over(const State& now, const Listing& listing) {
  return [&listing, at_same_level = back_over(now)](const State& state, std::uint32_t op, const Progress& progress) {
    return listing.begins_network(op) && at_same_level(state, op, progress);
  };
}

Stepper::Goal back_network_into(const Listing& listing) {
  return [&listing](const State&, std::uint32_t op, const Progress&) { return listing.begins_network(op); };
}

Stepper::Goal back_interrupt_begins(const Program& program) {
  return [&program](const State&, std::uint32_t op, const Progress&) { return is_interrupt_head(program, op); };
}

Stepper::Goal back_interrupt_ends(const Program& program) {
  return [&program](const State& state, std::uint32_t op, const Progress&) {
    const Instruction& instruction = *program.ops[op].instruction;
    if (instruction.structure == Structure::InterruptEnd) return true;
    return state.in_interrupt && state.call_depth == state.saved.call_depth &&
           instruction.effect == Effect::ConditionalEnd && state.stack.top();
  };
}

}  // namespace s7200::tools::goal
