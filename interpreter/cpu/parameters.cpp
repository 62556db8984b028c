#include "interpreter/cpu/parameters.hpp"

#include <optional>
#include <span>

#include "interpreter/cpu/ports/freeport.hpp"
#include "interpreter/cpu/scan.hpp"

namespace s7200 {
namespace parameters {
namespace {

std::span<const Parameter> parameters_of(const Core& core, const Op& call) {
  return std::span(core.program().parameters).subspan(call[1].at, call[2].at);
}

std::uint32_t read(const Core& core, const Operand& from, Width width) {
  return load_value(&core.s.image[from.at], width, from.bit);
}

void write(Core& core, const Operand& to, Width width, std::uint32_t value) {
  switch (width) {
    case Width::Bit:
      return core.put_bit(to.at, to.bit, value != 0);
    case Width::Byte:
      return core.put(to, static_cast<std::uint8_t>(value));
    case Width::Word:
      return core.put(to, static_cast<std::uint16_t>(value));
    case Width::Double:
      return core.put(to, value);
  }
}

/// The caller's operand itself; nothing after error 0006.
std::optional<Operand> direct(Core& core, const Parameter& parameter) {
  Operand operand = parameter.actual;
  if (!operand.pointer) return operand;
  const auto place = core.resolve(load32(&core.s.image[operand.at]), operand.width);
  if (!place || (Core::is_beyond_memory(*place) && !Core::may_be_reached(*place, operand.width, parameter.role))) {
    core.run_error(RunError::IndirectAddress);
    return {};
  }
  operand.at = *place;
  operand.pointer = false;
  return operand;
}

bool is_special_memory(const Operand& operand) { return operand.at >= image::kSM && operand.at < image::kS; }

}  // namespace

Values results(const Core& core, const Op& call) {
  Values values{};
  std::size_t i = 0;
  for (const Parameter& parameter : parameters_of(core, call)) values[i++] = read(core, parameter.local, parameter.width);
  return values;
}

void hand_back(Core& core, const Op& call, const Values& values) {
  bool port_control = false;
  std::size_t i = 0;
  for (const Parameter& parameter : parameters_of(core, call)) {
    const std::uint32_t value = values[i++];
    if (parameter.role == Role::In) continue;
    const auto to = direct(core, parameter);
    if (!to) continue;
    write(core, *to, parameter.width, value);
    port_control |= is_special_memory(*to);
  }
  if (port_control) freeport::follow_control(core);
}

}  // namespace parameters

void run_with_parameters(Core& core, const Op& op) {
  parameters::Values values{};
  std::size_t i = 0;
  for (const Parameter& parameter : parameters::parameters_of(core, op)) {
    const std::size_t at = i++;
    if (parameter.role == Role::Out) continue;
    const auto from = parameters::direct(core, parameter);
    if (!from) return;
    values[at] = parameters::read(core, *from, parameter.width);
  }
  if (!scan::call(core, op.target)) return;
  i = 0;
  for (const Parameter& parameter : parameters::parameters_of(core, op)) {
    const std::size_t at = i++;
    if (parameter.role != Role::Out) parameters::write(core, parameter.local, parameter.width, values[at]);
  }
}

}  // namespace s7200
