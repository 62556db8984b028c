#include "interpreter/cpu/core.hpp"

#include <algorithm>

#include "interpreter/cpu/scan.hpp"

namespace s7200 {

bool Core::in_area(std::uint32_t at, std::uint32_t count) const {
  if (at >= image::kV && at < image::kL)  // where most blocks are
    return at + count <= image::kV + model().size_of(Area::V);
  for (const AreaInfo& area : all_areas()) {
    const std::uint32_t size = model().size_of(area.area) * std::max(1u, area.element);
    if (at >= area.base && at < area.base + size) return at + count <= area.base + size;
  }
  return false;
}

void Core::run_error(RunError code) {
  if (loop.pause_at_error) {
    loop.paused = true;
    attend();
  }
  s.image[sm::kInterruptStatus] |= sm::kRuntimeError;
  ++s.error_count;
  trace({.at = s.time, .kind = TraceKind::RuntimeError, .code = static_cast<std::uint16_t>(code), .op = current_op()});
  for (RuntimeError& error : s.errors) {
    if (error.count != 0 && (error.code != static_cast<std::uint16_t>(code) || error.op != current_op())) continue;
    if (error.count == 0) error = {static_cast<std::uint16_t>(code), current_op(), 0, s.time};
    ++error.count;
    return;
  }
}

void Core::fatal_error(FatalError code) {
  s.fatal_code = static_cast<std::uint16_t>(code);
  s.fatal_op = current_op();
  trace({.at = s.time, .kind = TraceKind::FatalError, .code = s.fatal_code, .op = s.fatal_op});
  scan::enter_stop(*this);
}

bool Core::may_be_reached(std::uint32_t at, std::uint32_t width, Role role) {
  const bool analog_word = width == 2 && at % 2 == 0;
  if (at < image::kS) return role == Role::In || at >= image::kSM + kReadOnlySpecialMemory;
  if (at < image::kAI) return true;
  return analog_word && role == (at < image::kAQ ? Role::In : Role::Out);
}

/// Turns a pointer operand into a direct one, so that the body finds only direct operands.
/// Not documented, modelled so: all pointers are followed before anything else is checked, so an instruction with a bad
/// pointer and a bad count or range reports 0006. [Choices.ABadPointerIsReportedBeforeABadCountOrRange]
/// Not documented, modelled so: a pointer to special or analog memory that an instruction may not use so is a bad one.
/// [Pointers.WhatIsReadOnlyIsNotWrittenThroughThem]
static bool follow_pointer(Core& core, const Op& op, Op& direct, std::size_t i) {
  Operand& operand = direct.operand[i];
  const auto place = core.resolve(load32(&core.s.image[operand.at]), operand.width);
  const bool good = place && (!Core::is_beyond_memory(*place) ||
                              Core::may_be_reached(*place, operand.width, op.instruction->operand[i].role));
  if (good) {
    operand.at = *place;
    return true;
  }
  if (op.instruction->structure == Structure::Compare)
    core.compare_error(RunError::IndirectAddress, FatalError::CompareIndirect);
  else
    core.run_error(RunError::IndirectAddress);
  return false;
}

/// The body of an op whose written operand a pointer has led to special or analog memory.
[[gnu::noinline]] static void run_beyond_memory(Core& core, Op& direct, std::uint32_t at) {
  direct.has_pointer = false;
  if (at < image::kS) return run_with_port_control(core, direct);
  if (at >= image::kAQ) return run_with_analog_output(core, direct);
  direct.direct_body()(core, direct);
}

void run_with_pointers(Core& core, const Op& op) {
  Op direct = op;
  std::uint32_t beyond = 0;
  for (std::size_t i = 0; i < direct.operand.size(); ++i) {
    if (!direct.operand[i].pointer) continue;
    if (!follow_pointer(core, op, direct, i)) return;
    const bool written = op.outputs >> i & 1;
    if (written && Core::is_beyond_memory(direct.operand[i].at)) beyond = direct.operand[i].at;
  }
  if (beyond != 0) return run_beyond_memory(core, direct, beyond);
  op.direct_body()(core, direct);
}

void run_with_eno(Core& core, const Op& op) {
  const Instruction& box = *op.instruction;
  const std::uint64_t errors = core.s.error_count;
  core.s.eno = true;
  core.program().box_body[core.loop.op](core, op);
  const bool failed = box.rung.eno == Eno::ErrorsAndFlags && (core.s.image[sm::kFlags] & box.flags & kFailures) != 0;
  if (failed || core.s.error_count != errors) core.s.eno = false;
}

template <std::size_t i>
static void run_with_pointer(Core& core, const Op& op) {
  Op direct = op;
  if (!follow_pointer(core, op, direct, i)) return;
  const std::uint32_t at = direct.operand[i].at;
  const bool written = op.outputs >> i & 1;
  if (written && Core::is_beyond_memory(at)) return run_beyond_memory(core, direct, at);
  op.direct_body()(core, direct);
}

void run_with_pointer_first(Core& core, const Op& op) { run_with_pointer<0>(core, op); }
void run_with_pointer_second(Core& core, const Op& op) { run_with_pointer<1>(core, op); }

}  // namespace s7200
