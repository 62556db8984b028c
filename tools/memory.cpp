#include "tools/memory.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>

#include "interpreter/base/bytes.hpp"
#include "tools/terminal.hpp"

namespace s7200::tools {
namespace {

std::string bytes_text(const State& state, const MemoryRange& range) {
  std::string text;
  for (std::uint32_t i = 0; i < range.count; i += 16) {
    std::string hex, characters;
    for (std::uint32_t k = i; k < std::min(range.count, i + 16); ++k) {
      const std::uint8_t byte = state.image[range.at + k];
      hex += fmt::format(" {:02x}", byte);
      characters += byte >= 32 && byte < 127 ? static_cast<char>(byte) : '.';
    }
    text += fmt::format("{:<8}{:<49} {}\n", range.name_of(i), hex, characters);
  }
  return text;
}

std::string value_text(const std::uint8_t* from, Width width) {
  if (width == Width::Word) {
    const std::uint16_t value = load16(from);
    return fmt::format("16#{:04X} {:>11}", value, static_cast<std::int16_t>(value));
  }
  const std::uint32_t value = load32(from);
  return fmt::format("16#{:08X} {:>11}", value, static_cast<std::int32_t>(value));
}

}  // namespace

bool parse_assignments(const std::vector<std::string>& texts, const CpuModel& model, std::vector<Assignment>& assignments) {
  for (const std::string& text : texts) {
    std::string why;
    const auto assignment = parse_assignment(text, model, why);
    if (!assignment) {
      print_error(why);
      return false;
    }
    assignments.push_back(*assignment);
  }
  return true;
}

bool parse_ranges(const std::vector<std::string>& texts, const CpuModel& model, std::vector<MemoryRange>& ranges) {
  for (const std::string& text : texts) {
    std::string why;
    const auto range = parse_range(text, model, why);
    if (!range) {
      print_error(why);
      return false;
    }
    ranges.push_back(*range);
  }
  return true;
}

void assign(serial::Simulation& simulation, const Assignment& assignment) {
  Cpu& cpu = simulation.cpu();
  const MemoryRange& place = assignment.place;
  std::array<std::uint8_t, 4> big_endian{};
  store32(big_endian.data(), assignment.value);
  std::span<const std::uint8_t> bytes(big_endian.data() + 4 - s7200::bytes_of(place.width), s7200::bytes_of(place.width));
  std::uint8_t byte_with_bit = 0;
  if (place.width == Width::Bit) {
    const bool input = place.area == Area::I;
    byte_with_bit = cpu.state().image[input ? place.at - image::kI + image::kInputs : place.at];
    const auto mask = static_cast<std::uint8_t>(1u << place.bit);
    byte_with_bit = static_cast<std::uint8_t>(assignment.value ? byte_with_bit | mask : byte_with_bit & ~mask);
    bytes = {&byte_with_bit, 1};
  }
  if (place.area != Area::I) return cpu.poke(place.at, bytes);
  for (std::uint32_t i = 0; i < bytes.size(); ++i) cpu.set_input(place.number + i, bytes[i], cpu.time());
}

std::vector<std::uint8_t> bytes_of(const State& state, const MemoryRange& range) {
  if (range.width == Width::Bit) return {static_cast<std::uint8_t>((state.image[range.at] >> range.bit) & 1)};
  const auto begin = state.image.begin() + range.at;
  return {begin, begin + range.bytes()};
}

std::string dump_text(const State& state, const MemoryRange& range) {
  if (range.width == Width::Bit) return fmt::format("{:<8} {}\n", range.name_of(0), bytes_of(state, range)[0]);
  if (range.width == Width::Byte) return bytes_text(state, range);
  std::string text;
  const std::uint32_t step = range.area == Area::AC ? 4 : s7200::bytes_of(range.width);
  for (std::uint32_t i = 0; i < range.count; ++i)
    text += fmt::format("{:<8} {}\n", range.name_of(i), value_text(&state.image[range.at + i * step], range.width));
  return text;
}

}  // namespace s7200::tools
