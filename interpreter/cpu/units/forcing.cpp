#include "interpreter/cpu/units/forcing.hpp"

#include <algorithm>
#include <cassert>

#include "interpreter/cpu/units/points.hpp"

namespace s7200::forcing {
namespace {

bool is_analog(Area area) { return area == Area::AI || area == Area::AQ; }

ForcedPoints* points_of(Forcing& forcing, Area area) {
  if (area == Area::I) return &forcing.inputs;
  return area == Area::Q ? &forcing.outputs : nullptr;
}

/// Calls `act` with each byte of points in the place, the bits concerned, and the value of the byte.
template <class Act>
void each_byte(const MemoryRange& place, std::uint32_t value, const Act& act) {
  if (place.width == Width::Bit) {
    const auto mask = static_cast<std::uint8_t>(1u << place.bit);
    return act(place.number, mask, value != 0 ? mask : std::uint8_t{0});
  }
  const std::uint32_t bytes = place.bytes();
  for (std::uint32_t i = 0; i < bytes; ++i)
    act(place.number + i, std::uint8_t{0xFF}, static_cast<std::uint8_t>(value >> 8 * ((bytes - 1 - i) % 4)));
}

void note_any(Forcing& forcing) { forcing.any = forcing.values != 0 || forcing.inputs.any() || forcing.outputs.any(); }

bool release_values(Forcing& forcing, const MemoryRange& place) {
  const auto end = forcing.memory.begin() + forcing.values;
  const auto kept = std::remove_if(forcing.memory.begin(), end, [&](const ForcedValue& value) {
    return value.at < place.at + place.bytes() && place.at < value.at + bytes_of(value.width);
  });
  if (kept == end) return false;
  std::fill(kept, end, ForcedValue{});
  forcing.values = static_cast<std::uint8_t>(kept - forcing.memory.begin());
  return true;
}

bool release(Forcing& forcing, const MemoryRange& place) {
  ForcedPoints* const points = points_of(forcing, place.area);
  bool any = points == nullptr && release_values(forcing, place);
  if (points)
    each_byte(place, 0, [&](std::uint32_t byte, std::uint8_t mask, std::uint8_t) {
      any |= (points->mask[byte] & mask) != 0;
      points->mask[byte] = static_cast<std::uint8_t>(points->mask[byte] & ~mask);
      points->value[byte] = static_cast<std::uint8_t>(points->value[byte] & ~mask);
    });
  note_any(forcing);
  return any;
}

void write(Core& core, const ForcedValue& forced) {
  const Operand operand{.at = forced.at};
  if (forced.width == Width::Byte) core.put(operand, static_cast<std::uint8_t>(forced.value));
  if (forced.width == Width::Word) core.put(operand, static_cast<std::uint16_t>(forced.value));
  if (forced.width == Width::Double) core.put(operand, forced.value);
}

/// Does what follows at once from the values that are forced now.
void take_effect(Core& core) {
  for (std::uint32_t byte = 0; byte < image::kPointBytes; ++byte) core.s.image[image::kInputs + byte] = input(core.s, byte);
  apply(core);
  if (core.model().self & kCpu22x) core.put_mask(sm::kInterruptStatus, sm::kForced, core.s.forcing.any);
}

std::optional<MemoryRange> range_of(const ForcedValue& value) {
  for (const Area area : {Area::M, Area::AI, Area::AQ, Area::V}) {
    const AreaInfo& is = info(area);
    const std::uint32_t size = area == Area::M ? 32u : is_analog(area) ? 64u : std::uint32_t{image::kL - image::kV};
    if (value.at >= is.base && value.at < is.base + size)
      return MemoryRange{.area = area, .width = value.width, .number = value.at - is.base, .at = value.at};
  }
  return {};
}

void list_points(const ForcedPoints& points, Area area, std::vector<Assignment>& all) {
  for (std::uint32_t byte = 0; byte < image::kPointBytes; ++byte)
    for (std::uint8_t bit = 0; bit < 8; ++bit)
      if (points.mask[byte] >> bit & 1)
        all.push_back({{.area = area, .width = Width::Bit, .number = byte, .bit = bit, .at = info(area).base + byte},
                       std::uint32_t{points.value[byte]} >> bit & 1});
}

}  // namespace

bool possible(const MemoryRange& place) {
  if (place.area == Area::I || place.area == Area::Q) return true;
  if (is_analog(place.area)) return place.width == Width::Word && place.count == 1 && place.number % 2 == 0;
  return (place.area == Area::V || place.area == Area::M) && place.width != Width::Bit && place.count == 1;
}

bool add(Forcing& forcing, const MemoryRange& place, std::uint32_t value) {
  assert(possible(place));
  if (ForcedPoints* const points = points_of(forcing, place.area)) {
    each_byte(place, value, [&](std::uint32_t byte, std::uint8_t mask, std::uint8_t bits) {
      points->mask[byte] = static_cast<std::uint8_t>(points->mask[byte] | mask);
      points->value[byte] = static_cast<std::uint8_t>((points->value[byte] & ~mask) | bits);
    });
  } else {
    Forcing without = forcing;
    release_values(without, place);
    if (without.values == without.memory.size()) return false;
    forcing = without;
    const std::uint32_t bits = UINT32_MAX >> (32 - 8 * bytes_of(place.width));
    forcing.memory[forcing.values++] = {place.at, value & bits, place.width};
  }
  note_any(forcing);
  return true;
}

std::vector<Assignment> listed(const Forcing& forcing) {
  std::vector<Assignment> all;
  list_points(forcing.inputs, Area::I, all);
  list_points(forcing.outputs, Area::Q, all);
  for (std::uint8_t i = 0; i < forcing.values; ++i)
    if (const auto place = range_of(forcing.memory[i])) all.push_back({*place, forcing.memory[i].value});
  return all;
}

bool force(Core& core, const MemoryRange& place, std::uint32_t value) {
  const bool room = add(core.s.forcing, place, value);
  take_effect(core);
  if (room && core.s.mode == Mode::Stop) points::write_stop_outputs(core);
  return room;
}

bool unforce(Core& core, const MemoryRange& place) {
  const bool any = release(core.s.forcing, place);
  if (any && place.area == Area::AI)
    std::copy_n(core.s.analog_terminals.begin() + (place.at - image::kAI), place.bytes(), core.s.image.begin() + place.at);
  take_effect(core);
  if (any && core.s.mode == Mode::Stop) points::write_stop_outputs(core);
  return any;
}

void put_over(const State& s, std::uint32_t at, std::span<std::uint8_t> bytes) {
  if (!s.forcing.any) return;
  for (std::uint32_t i = 0; i < bytes.size(); ++i) {
    const std::uint32_t input = at + i - image::kI, output = at + i - image::kQ;  // wraps below the area
    if (input < image::kPointBytes) bytes[i] = s.forcing.inputs.over(input, bytes[i]);
    if (output < image::kPointBytes) bytes[i] = s.forcing.outputs.over(output, bytes[i]);
  }
  for (std::uint8_t value = 0; value < s.forcing.values; ++value) {
    const ForcedValue& forced = s.forcing.memory[value];
    const std::uint32_t size = bytes_of(forced.width);
    for (std::uint32_t i = 0; i < size; ++i)
      if (forced.at + i >= at && forced.at + i - at < bytes.size())
        bytes[forced.at + i - at] = static_cast<std::uint8_t>(forced.value >> 8 * (size - 1 - i));
  }
}

std::vector<std::uint8_t> seen_outside(const State& s, const MemoryRange& place) {
  std::vector<std::uint8_t> bytes(s.image.begin() + place.at, s.image.begin() + place.at + place.bytes());
  put_over(s, place.at, bytes);
  return place.width == Width::Bit ? std::vector{static_cast<std::uint8_t>(bytes[0] >> place.bit & 1)} : bytes;
}

void apply(Core& core) {
  for (std::uint8_t i = 0; i < core.s.forcing.values; ++i) write(core, core.s.forcing.memory[i]);
}

void power_up(Core& core, const RetentiveMemory* memory) {
  if (!memory) return;
  core.s.forcing = memory->forcing;
  take_effect(core);
}

/// The images of forced outputs, before the points follow them.
void end_scan(Core& core) {
  if (!core.s.forcing.any) return;
  for (std::uint32_t byte = 0; byte < image::kPointBytes; ++byte) {
    std::uint8_t& image = core.s.image[image::kQ + byte];
    image = output(core.s, byte, image);
  }
}

}  // namespace s7200::forcing
