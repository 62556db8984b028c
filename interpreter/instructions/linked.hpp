// The fast loop is threaded code by tail calls: every op has a link, which executes it and calls the link of the next op as
// its last act. The compiler makes that call a jump, so clock, logic stack and count stay in registers, and the processor
// predicts each jump by itself. A chain of contacts and coils is a superinstruction: one link for all of them.
//
// A link that would reach the end of its time leaves before it does anything. The plain loop (cpu.cpp) executes what is
// left, op by op: it decides what happens at a deadline, and nothing here knows of deadlines inside a chain.
//
// A build that does not make jumps of these calls would run out of stack, so it has no links and only the plain loop: GCC
// without optimisation, and WebAssembly without tail calls. [FastLoop.NeedsNoMoreStackForMoreInstructions]
#pragma once

#include "interpreter/cpu/core.hpp"

#if defined(__wasm__) && !defined(__wasm_tail_call__)
#define S7200_TAIL_CALL return
#elif defined(__clang__)
#define S7200_TAIL_CALL [[clang::musttail]] return
#else
#define S7200_TAIL_CALL return
#endif

namespace s7200::linked {

#if defined(__wasm__) && !defined(__wasm_tail_call__)
inline constexpr bool kTailCalls = false;
#elif defined(__clang__) || defined(__OPTIMIZE__)
inline constexpr bool kTailCalls = true;
#else
inline constexpr bool kTailCalls = false;
#endif

/// Back to the CPU, with the state as it is before `op`.
inline void leave(Core& core, const Op* op, Time left, std::uint64_t stack, std::uint64_t executed) {
  core.s.time = core.loop.until - left;
  core.s.pc = static_cast<std::uint32_t>(op - core.program().ops.data());
  core.s.stack = LogicStack::from_bits(stack);
  core.s.instructions += executed;
}

/// A body that may do anything: it finds and leaves the state as the plain loop has it. Null: the body that the op names.
template <Body body>
[[gnu::noinline]] void execute_on_core(Core& core, const Op* op, Time left, std::uint64_t stack, std::uint64_t executed) {
  if (left <= op->cost) return leave(core, op, left, stack, executed);
  const Op* const ops = core.program().ops.data();
  core.s.time = core.loop.until - left + op->cost;
  core.s.stack = LogicStack::from_bits(stack);
  core.loop.op = static_cast<std::uint32_t>(op - ops);
  core.s.pc = core.loop.op + 1;
  if constexpr (body == nullptr)
    op->body(core, *op);
  else
    body(core, *op);
  const Op* const next = ops + core.s.pc;
  left = core.loop.until - core.s.time;
  if (left <= 0) {
    core.s.instructions += executed + 1;
    return;
  }
  S7200_TAIL_CALL next->link(core, next, left, core.s.stack.bits(), executed + 1);
}

/// Executes a body that needs no power flow, and after which the loop has to look for other work: there is no next op.
template <Body body>
void last_on_core(Core& core, const Op* op, Time left, std::uint64_t stack, std::uint64_t executed) {
  if (left <= op->cost) return leave(core, op, left, stack, executed);
  core.s.time = core.loop.until - left + op->cost;
  core.s.stack = LogicStack::from_bits(stack);
  core.loop.op = static_cast<std::uint32_t>(op - core.program().ops.data());
  core.s.pc = core.loop.op + 1;
  body(core, *op);
  core.s.instructions += executed + 1;
}

/// Executes a body like execute_on_core() where there may be no power flow. It is a function of its own because it needs no
/// registers saved.
template <Body body>
void on_core(Core& core, const Op* op, Time left, std::uint64_t stack, std::uint64_t executed) {
  if (!(op->power_mask & ~stack)) S7200_TAIL_CALL execute_on_core<body>(core, op, left, stack, executed);
  const Program& program = core.program();
  if (left <= program.no_power_flow) return leave(core, op, left, stack, executed);
  if constexpr (body == nullptr) core.s.eno &= !op->sets_eno;  // what sets ENO has a step around its body
  const Op* const next = program.ops.data() + op->skip_to;
  S7200_TAIL_CALL next->link(core, next, left - program.no_power_flow, stack, executed + 1);
}

/// A body that needs no power flow, and works on nothing but the logic stack and memory.
template <Body body>
void on_stack(Core& core, const Op* op, Time left, std::uint64_t stack, std::uint64_t executed) {
  if (left <= op->cost) return leave(core, op, left, stack, executed);
  core.s.stack = LogicStack::from_bits(stack);
  body(core, *op);
  const Op* const next = op + 1;
  S7200_TAIL_CALL next->link(core, next, left - op->cost, core.s.stack.bits(), executed + 1);
}

/// A box that works on nothing but memory.
template <Body body>
void on_memory(Core& core, const Op* op, Time left, std::uint64_t stack, std::uint64_t executed) {
  const bool powered = stack & 1;
  const Time time = powered ? op->cost : core.program().no_power_flow;
  if (left <= time) return leave(core, op, left, stack, executed);
  if (powered) body(core, *op);
  const Op* const next = op + 1;
  S7200_TAIL_CALL next->link(core, next, left - time, stack, executed + 1);
}

}  // namespace s7200::linked

namespace s7200::bodies {

/// A row's body with the link for what it works on. A body without any of them is called by link_of_any().
template <Body body>
inline constexpr Bodies kOnCore{body, nullptr, linked::on_core<body>};
template <Body body>
inline constexpr Bodies kLastOnCore{body, nullptr, linked::last_on_core<body>};
template <Body body>
inline constexpr Bodies kOnStack{body, nullptr, linked::on_stack<body>};
template <Body body>
inline constexpr Bodies kOnMemory{body, nullptr, linked::on_memory<body>};

}  // namespace s7200::bodies
