#include "interpreter/cpu/units/points.hpp"

#include <algorithm>
#include <utility>

#include "interpreter/cpu/units.hpp"
#include "interpreter/cpu/units/forcing.hpp"
#include "interpreter/cpu/units/pulse_outputs.hpp"

namespace s7200 {
namespace points {
namespace {

/// Writes an output byte; points with running pulse outputs keep their level.
void put_outputs(Core& core, std::uint32_t byte, std::uint8_t value) {
  std::uint8_t& points = core.s.image[image::kOutputs + byte];
  value = forcing::output(core.s, byte, value);
  for (std::uint8_t output = 0; output < core.s.pulse.size(); ++output) {
    const auto mask = static_cast<std::uint8_t>(1u << output);
    if (pulse_outputs::drive(core, byte, output)) value = static_cast<std::uint8_t>((value & ~mask) | (points & mask));
  }
  if (points == value) return;
  const std::uint8_t before = std::exchange(points, value);
  core.tell_of_outputs(byte, before, core.s.time);
}

using AnalogOutputs = std::array<std::uint8_t, image::kT - image::kAQ>;

AnalogOutputs analog_outputs(const Core& core) {
  AnalogOutputs outputs{};
  std::copy_n(core.s.image.begin() + image::kAQ, outputs.size(), outputs.begin());
  return outputs;
}

void force_analog_outputs(Core& core) {
  for (std::uint8_t i = 0; i < core.s.forcing.values; ++i) {
    const ForcedValue& forced = core.s.forcing.memory[i];
    if (forced.at >= image::kAQ && forced.at < image::kT)
      store16(&core.s.image[forced.at], static_cast<std::uint16_t>(forced.value));
  }
}

void trace_analog_changes(const Core& core, const AnalogOutputs& before) {
  for (std::uint32_t word = 0; word < core.model().size_of(Area::AQ); word += 2) {
    const std::uint16_t value = load16(&core.s.image[image::kAQ + word]);
    if (value != load16(&before[word]))
      core.trace({.at = core.s.time, .kind = TraceKind::AnalogChanged, .op = word, .count = value});
  }
}

}  // namespace

void set_inputs(Core& core, std::uint32_t byte, std::uint8_t value, Time at) {
  std::uint8_t& terminals = core.s.terminals[byte];
  const std::uint8_t changed = terminals ^ value;
  terminals = value;
  core.s.image[image::kInputs + byte] = forcing::input(core.s, byte);
  if (changed != 0) units::inputs_changed(core, byte, changed, at);
}

void put_output(Core& core, std::uint32_t byte, std::uint8_t bit, bool value, Time at) {
  const std::uint8_t before = core.s.image[image::kOutputs + byte];
  core.put_bit(image::kOutputs + byte, bit, value);
  if (core.s.image[image::kOutputs + byte] != before) core.tell_of_outputs(byte, before, at);
}

void write_output(Core& core, std::uint32_t byte, std::uint8_t bit, bool value) {
  if (pulse_outputs::drive(core, byte, bit)) return;
  const auto byte_with_bit = static_cast<std::uint8_t>(value ? 1u << bit : 0u);
  put_output(core, byte, bit, forcing::output(core.s, byte, byte_with_bit) >> bit & 1, core.s.time);
}

/// All output points go off, which is the default of the output table for STOP (facts 9.1).
void enter_stop(Core& core) {
  core.s.stop_outputs = {};
  write_stop_outputs(core);
}

void write_stop_outputs(Core& core) {
  for (std::uint32_t byte = 0; byte < core.model().size_of(Area::Q); ++byte)
    put_outputs(core, byte, core.s.stop_outputs[byte]);
}

bool can_be_set_in_stop(const MemoryRange& place) {
  return place.area == Area::Q || (place.area == Area::AQ && forcing::possible(place));
}

void set_in_stop(Core& core, const MemoryRange& place, std::uint32_t value) {
  if (place.area == Area::AQ) {
    store16(&core.s.image[place.at], static_cast<std::uint16_t>(value));
    return core.trace({.at = core.s.time, .kind = TraceKind::AnalogChanged, .op = place.number, .count = value});
  }
  std::uint8_t* const outputs = &core.s.stop_outputs[place.number];
  if (place.width == Width::Bit)
    *outputs = static_cast<std::uint8_t>((*outputs & ~(1U << place.bit)) | value << place.bit);
  else
    for (std::uint32_t i = place.bytes(); i-- > 0; value >>= 8) outputs[i] = static_cast<std::uint8_t>(value);
  write_stop_outputs(core);
}

void write_outputs(Core& core) {
  for (std::uint32_t byte = 0; byte < core.model().size_of(Area::Q); ++byte)
    put_outputs(core, byte, core.s.image[image::kQ + byte]);
}

}  // namespace points

void run_with_analog_output(Core& core, const Op& op) {
  const auto before = points::analog_outputs(core);
  if (op.has_pointer)
    run_with_pointers(core, op);
  else
    op.direct_body()(core, op);
  if (core.s.forcing.values != 0) points::force_analog_outputs(core);
  points::trace_analog_changes(core, before);
}

}  // namespace s7200
