#include "interpreter/cpu/cpu.hpp"

#include <algorithm>
#include <utility>

namespace s7200 {

Cpu::Cpu(std::shared_ptr<const Program> program, EventQueue& queue, SerialPort& port)
    : program_(std::move(program)), ops_(program_->ops.data()), reach_(program_->reach.data()), queue_(queue), port_(port) {
  s.attached.fill(kNotAttached);
}

void Cpu::run(Time limit) {
  paused_ = false;
  const Mode mode = s.mode;
  while (s.time < limit && !paused_ && s.mode == mode) {
    const Time event = queue_.next();
    if (event <= s.time) return;
    if (s.watchdog <= s.time) {
      fatal_error(FatalError::Watchdog);
      continue;
    }
    until_ = std::min({limit, event, s.watchdog});
    if (interrupt_due()) take_interrupt();
    if (!s.in_interrupt && s.phase != Phase::Program)
      system_phases();
    else if (sink_ && sink_->wants_instructions())
      execute_observed();
    else
      execute_plain();
  }
}

void Cpu::execute_plain() {
  const Op* const ops = ops_;
  const Time no_power_flow = program_->no_power_flow;
  std::uint64_t executed = 0;
  while (s.time < until_) {
    op_ = s.pc;
    const Op& op = ops[op_];
    ++executed;
    if (op.power_mask & ~s.stack.bits()) {
      s.time += no_power_flow;
      s.pc = op.skip_to;
    } else {
      s.time += op.cost;
      s.pc = op_ + 1;
      op.body(*this, op);
    }
  }
  s.instructions += executed;
}

void Cpu::execute_observed() {
  while (s.time < until_) {
    if (!sink_->before(s.pc)) {
      paused_ = true;
      return;
    }
    op_ = s.pc;
    const Op& op = ops_[op_];
    InstructionRecord record{.at = s.time, .op = op_};
    for (std::size_t i = 0; i < op.instruction->operands; ++i)
      if (op.instruction->operand[i].role == Role::In) record.value[i] = peek(op, i);
    ++s.instructions;
    record.powered = !(op.power_mask & ~s.stack.bits());
    if (record.powered) {
      s.time += op.cost;
      s.pc = op_ + 1;
      op.body(*this, op);
    } else {
      s.time += program_->no_power_flow;
      s.pc = op.skip_to;
    }
    record.end = s.time;
    record.top = s.stack.top();
    for (std::size_t i = 0; i < op.instruction->operands; ++i)
      if (op.instruction->operand[i].role != Role::In) record.value[i] = peek(op, i);
    sink_->instruction(record);
  }
}

bool Cpu::in_area(std::uint32_t at, std::uint32_t count) const {
  if (at >= image::kV) return at + count <= image::kV + program_->model->size_of(Area::V);  // where most blocks lie
  for (const AreaInfo& area : all_areas()) {
    const std::uint32_t size = program_->model->size_of(area.area) * std::max(1u, area.element);
    if (at >= area.base && at < area.base + size) return at + count <= area.base + size;
  }
  return false;
}

bool Cpu::bits_in_area(const Operand& first, std::uint32_t count) const {
  for (const AreaInfo& area : all_areas()) {
    const std::uint32_t bits = program_->model->size_of(area.area) * (area.element ? 1 : 8);
    if (area.bits == kNoBits) continue;
    if (first.at < area.bits || first.at >= area.bits + (bits + 7) / 8) continue;
    return (first.at - area.bits) * 8 + first.bit + count <= bits;
  }
  return false;
}

void Cpu::clear_current_values(const Operand& first, std::uint32_t count) {
  for (const AreaInfo& area : {info(Area::T), info(Area::C)}) {
    if (first.at < area.bits || first.at >= area.bits + 32) continue;
    const std::uint32_t number = (first.at - area.bits) * 8 + first.bit;
    std::fill_n(s.image.begin() + area.base + number * 2, count * 2, std::uint8_t{0});
    if (area.area == Area::T) turn_timers_off(number, count);
  }
}

void Cpu::poke(std::uint32_t at, std::span<const std::uint8_t> bytes) {
  std::copy(bytes.begin(), bytes.end(), s.image.begin() + at);
  if (s.mode == Mode::Run) follow_port_control(s.time);
}

std::optional<std::uint32_t> Cpu::peek(const Op& op, std::size_t i) const {
  Operand operand = op[i];
  const OperandRule& rule = op.instruction->operand[i];
  if (rule.kind != OperandKind::Memory) return operand.at;
  if (operand.pointer) {
    const auto place = resolve(load32(&s.image[operand.at]), operand.width);
    if (!place) return {};
    operand.at = *place;
  }
  switch (rule.width) {
    case Width::Bit:
      return bit(operand);
    case Width::Byte:
      return get<std::uint8_t>(operand);
    case Width::Word:
      return get<std::uint16_t>(operand);
    case Width::Double:
      return get<std::uint32_t>(operand);
  }
  return {};
}

/// A pointer operand is an offset computed first: the body then finds direct operands only.
/// Not documented, modelled so: all pointers are followed before anything else is looked at, so that an instruction with a
/// bad pointer and a bad count or range reports 0006. [Choices.ABadPointerIsReportedBeforeABadCountOrRange]
static bool follow_pointer(Cpu& cpu, const Op& op, Operand& operand) {
  const auto place = cpu.resolve(load32(&cpu.s.image[operand.at]), operand.width);
  if (place) {
    operand.at = *place;
    return true;
  }
  if (op.instruction->structure == Structure::Compare)
    cpu.compare_error(RunError::IndirectAddress, FatalError::CompareIndirect);
  else
    cpu.run_error(RunError::IndirectAddress);
  return false;
}

void run_with_pointers(Cpu& cpu, const Op& op) {
  Op direct = op;
  for (Operand& operand : direct.operand)
    if (operand.pointer && !follow_pointer(cpu, op, operand)) return;
  op.direct_body()(cpu, direct);
}

void run_with_pointer_first(Cpu& cpu, const Op& op) {
  Op direct = op;
  if (follow_pointer(cpu, op, direct.operand[0])) op.direct_body()(cpu, direct);
}

void run_with_pointer_second(Cpu& cpu, const Op& op) {
  Op direct = op;
  if (follow_pointer(cpu, op, direct.operand[1])) op.direct_body()(cpu, direct);
}

void Cpu::run_error(RunError code) {
  if (pause_at_error_) {
    paused_ = true;
    attend();
  }
  s.image[image::kSM4] |= 0x08;
  ++s.error_count;
  trace({.at = s.time, .kind = TraceKind::RuntimeError, .code = static_cast<std::uint16_t>(code), .op = current_op()});
  for (RuntimeError& error : s.errors) {
    if (error.count != 0 && (error.code != static_cast<std::uint16_t>(code) || error.op != current_op())) continue;
    if (error.count == 0) error = {static_cast<std::uint16_t>(code), current_op(), 0, s.time};
    ++error.count;
    return;
  }
}

void Cpu::fatal_error(FatalError code) {
  s.fatal_code = static_cast<std::uint16_t>(code);
  s.fatal_op = current_op();
  trace({.at = s.time, .kind = TraceKind::FatalError, .code = s.fatal_code, .op = s.fatal_op});
  enter_stop();
}

std::string_view meaning_of(RunError code) {
  switch (code) {
    case RunError::CounterNotDefined:
      return "HSC before HDEF of that counter";
    case RunError::PointTaken:
      return "input interrupt attached to a point that a high-speed counter uses";
    case RunError::InputTaken:
      return "HDEF uses an input that an input interrupt is attached to";
    case RunError::Clock:
      return "TODW: the buffer holds no BCD";
    case RunError::CounterDefinedTwice:
      return "second HDEF for the same counter";
    case RunError::CompareValue:
      return "illegal value in a compare contact: not a real number (NaN)";
    case RunError::EepromRange:
      return "the V address to save lies outside the EEPROM";
    case RunError::IndirectAddress:
      return "indirect addressing error: the pointer leads outside the memory it may reach";
    case RunError::CallDepth:
      return "subroutines nested too deep";
    case RunError::PortBusy:
      return "XMT while port 0 is transmitting, or not in Freeport mode";
    case RunError::OperandRange:
      return "range error: the operand leaves its memory area";
    case RunError::Count:
      return "error in the count field of an instruction";
    case RunError::FreeportInInterrupt:
      return "attempt to switch to Freeport inside an interrupt routine";
  }
  return "unknown";
}

std::string_view meaning_of(FatalError code) {
  switch (code) {
    case FatalError::Watchdog:
      return "scan watchdog: the scan took longer than 300 ms without WDR";
    case FatalError::CompareIndirect:
      return "indirect addressing error in a compare contact";
    case FatalError::CompareValue:
      return "illegal value in a compare contact: not a real number (NaN)";
  }
  return "unknown";
}

}  // namespace s7200
