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

/// Turns a pointer operand into a direct one, so that the body finds only direct operands.
/// Not documented, modelled so: all pointers are followed before anything else is checked, so an instruction with a bad
/// pointer and a bad count or range reports 0006. [Choices.ABadPointerIsReportedBeforeABadCountOrRange]
static bool follow_pointer(Core& core, const Op& op, Operand& operand) {
  const auto place = core.resolve(load32(&core.s.image[operand.at]), operand.width);
  if (place) {
    operand.at = *place;
    return true;
  }
  if (op.instruction->structure == Structure::Compare)
    core.compare_error(RunError::IndirectAddress, FatalError::CompareIndirect);
  else
    core.run_error(RunError::IndirectAddress);
  return false;
}

void run_with_pointers(Core& core, const Op& op) {
  Op direct = op;
  for (Operand& operand : direct.operand)
    if (operand.pointer && !follow_pointer(core, op, operand)) return;
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

void run_with_pointer_first(Core& core, const Op& op) {
  Op direct = op;
  if (follow_pointer(core, op, direct.operand[0])) op.direct_body()(core, direct);
}

void run_with_pointer_second(Core& core, const Op& op) {
  Op direct = op;
  if (follow_pointer(core, op, direct.operand[1])) op.direct_body()(core, direct);
}

}  // namespace s7200
