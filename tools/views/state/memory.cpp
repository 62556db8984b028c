#include "tools/views/state/memory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>

#include "interpreter/base/bytes.hpp"
#include "interpreter/cpu/units/forcing.hpp"
#include "interpreter/stl/printer.hpp"
#include "tools/views/report.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

std::string bytes_text(const State& state, const MemoryRange& range) {
  const std::vector<std::uint8_t> bytes = forcing::seen_outside(state, range);
  std::string text;
  for (std::uint32_t i = 0; i < range.count; i += 16) {
    std::string hex, characters;
    for (std::uint32_t k = i; k < std::min(range.count, i + 16); ++k) {
      const std::uint8_t byte = bytes[k];
      hex += fmt::format(" {:02x}", byte);
      characters += byte >= 32 && byte < 127 ? static_cast<char>(byte) : '.';
    }
    text += fmt::format("{:<8}{:<49} {}\n", range.name_of(i), hex, characters);
  }
  return text;
}

float real_at(const std::uint8_t* from) { return std::bit_cast<float>(load32(from)); }

/// The bytes of object `i` of a range, from the left.
std::array<std::uint8_t, 4> object_at(const State& state, const MemoryRange& range, std::uint32_t i) {
  const std::uint32_t size = s7200::bytes_of(range.width);
  const std::uint32_t at = range.at + i * (range.area == Area::AC ? 4 : size);
  std::array<std::uint8_t, 4> bytes{};
  std::copy_n(state.image.begin() + at, size, bytes.begin());
  forcing::put_over(state, at, {bytes.data(), size});
  return bytes;
}

bool used_as_real(const Cpu& cpu, const MemoryRange& range, std::uint32_t i) {
  return range.width == Width::Double && cpu.program().is_real(range.at + 4 * i);
}

std::string object_text(const Cpu& cpu, const MemoryRange& range, std::uint32_t i) {
  const auto bytes = object_at(cpu.state(), range, i);
  const std::uint8_t* const from = bytes.data();
  if (range.width == Width::Word) {
    const std::uint16_t value = load16(from);
    return fmt::format("16#{:04X} {:>11}", value, static_cast<std::int16_t>(value));
  }
  const std::uint32_t value = load32(from);
  std::string text = fmt::format("16#{:08X}", value);
  if (!range.real) text += fmt::format(" {:>11}", static_cast<std::int32_t>(value));
  if (range.real || used_as_real(cpu, range, i)) text += fmt::format(" {:>15}", stl::to_text(stl::Real{real_at(from)}));
  return text;
}

}  // namespace

std::string_view type_of(const MemoryRange& range) {
  switch (range.width) {
    case Width::Bit:
      return "bit";
    case Width::Byte:
      return "byte";
    case Width::Word:
      return "word";
    case Width::Double:
      return range.real ? "real" : "dword";
  }
  return {};
}

nlohmann::ordered_json value_json(const State& state, const MemoryRange& range, std::uint32_t i) {
  const std::uint32_t bits = bits_at(state, range, i);
  switch (range.width) {
    case Width::Bit:
    case Width::Byte:
      return bits;
    case Width::Word:
      return static_cast<std::int16_t>(bits);
    case Width::Double:
      if (range.real) return real_json(std::bit_cast<float>(bits));
      return static_cast<std::int32_t>(bits);
  }
  return nullptr;
}

std::vector<Assignment> inputs_as_before(const Cpu& cpu, const State& before) {
  const CpuModel& model = *cpu.program().model;
  const State& now = cpu.state();
  std::vector<Assignment> changes;
  for (std::uint32_t byte = 0; byte < model.size_of(Area::I); ++byte)
    if (now.terminals[byte] != before.terminals[byte])
      changes.push_back({{Area::I, Width::Byte, byte, 0, 1, info(Area::I).base + byte}, before.terminals[byte]});
  for (std::uint32_t byte = 0; byte + 1 < model.size_of(Area::AI); byte += 2) {
    const std::uint16_t level = load16(&before.analog_terminals[byte]);
    if (level != load16(&now.analog_terminals[byte]))
      changes.push_back({{Area::AI, Width::Word, byte, 0, 1, info(Area::AI).base + byte}, level});
  }
  return changes;
}

void assign(Cpu& cpu, const Assignment& assignment) {
  const MemoryRange& place = assignment.place;
  std::array<std::uint8_t, 4> big_endian{};
  store32(big_endian.data(), assignment.value);
  std::span<const std::uint8_t> bytes(big_endian.data() + 4 - s7200::bytes_of(place.width), s7200::bytes_of(place.width));
  std::uint8_t byte_with_bit = 0;
  if (place.width == Width::Bit) {
    const bool input = place.area == Area::I;
    byte_with_bit = input ? cpu.terminals(place.number) : cpu.state().image[place.at];
    const auto mask = static_cast<std::uint8_t>(1u << place.bit);
    byte_with_bit = static_cast<std::uint8_t>(assignment.value ? byte_with_bit | mask : byte_with_bit & ~mask);
    bytes = {&byte_with_bit, 1};
  }
  if (place.area != Area::I) return cpu.poke(place.at, bytes);
  for (std::uint32_t i = 0; i < bytes.size(); ++i) cpu.set_input(place.number + i, bytes[i], cpu.time());
}

std::string hex_text(const Assignment& assignment) {
  const std::uint32_t digits = assignment.place.width == Width::Bit ? 1 : 2 * s7200::bytes_of(assignment.place.width);
  const std::uint32_t value = digits == 8 ? assignment.value : assignment.value & ((1U << 4 * digits) - 1);
  return fmt::format("16#{:0{}X}", value, digits);
}

std::string dump_text(const Cpu& cpu, const MemoryRange& range) {
  const State& state = cpu.state();
  if (range.width == Width::Bit) return fmt::format("{:<8} {}\n", range.name_of(0), bits_at(state, range, 0));
  if (range.width == Width::Byte) return bytes_text(state, range);
  std::string text;
  for (std::uint32_t i = 0; i < range.count; ++i)
    text += fmt::format("{:<8} {}\n", range.name_of(i), object_text(cpu, range, i));
  return text;
}

std::uint32_t bits_at(const State& state, const MemoryRange& range, std::uint32_t i) {
  const auto bytes = object_at(state, range, i);
  if (range.width == Width::Bit) return bytes[0] >> range.bit & 1;
  if (range.width == Width::Byte) return bytes[0];
  return range.width == Width::Word ? load16(bytes.data()) : load32(bytes.data());
}

double number_at(const State& state, const MemoryRange& range, std::uint32_t i) {
  const std::uint32_t bits = bits_at(state, range, i);
  if (range.real) return std::bit_cast<float>(bits);
  if (range.width == Width::Word) return static_cast<std::int16_t>(bits);
  return range.width == Width::Double ? static_cast<double>(static_cast<std::int32_t>(bits)) : bits;
}

nlohmann::ordered_json dump_json(const Cpu& cpu, const MemoryRange& range) {
  nlohmann::ordered_json json{{"type", type_of(range)}, {"hex", plain_hex(forcing::seen_outside(cpu.state(), range))}};
  auto values = nlohmann::ordered_json::array(), reals = values;
  bool any_real = false;
  for (std::uint32_t i = 0; i < range.count; ++i) {
    values.push_back(value_json(cpu.state(), range, i));
    const bool real = !range.real && used_as_real(cpu, range, i);
    reals.push_back(real ? real_json(real_at(object_at(cpu.state(), range, i).data())) : nullptr);
    any_real |= real;
  }
  json["values"] = values;
  if (any_real) json["reals"] = reals;
  return json;
}

}  // namespace s7200::tools
