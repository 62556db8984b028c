#include "tools/session/words/element_text.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/bytes.hpp"

namespace s7200::tools {
namespace {

std::string counter_preset_text(const Cpu& cpu, std::uint32_t number) {
  const std::vector<Op>& ops = cpu.program().ops;
  const std::uint32_t at = info(Area::C).base + number * info(Area::C).step();
  const auto counts =
      std::ranges::find_if(ops, [&](const Op& op) { return op.instruction->mnemonic.starts_with("CT") && op[0].at == at; });
  const auto preset = counts == ops.end() ? std::nullopt : cpu.place_of((*counts)[1]);
  return preset ? fmt::format(", preset {}", static_cast<std::int16_t>(load16(&cpu.state().image[*preset]))) : "";
}

std::string counter_text(const HighSpeedCounter& counter) {
  if (!counter.defined) return "not defined";
  return fmt::format("mode {}, preset {}, {}{}", counter.mode, counter.preset, counter.up ? "up" : "down",
                     counter.enabled ? "" : ", not enabled");
}

}  // namespace

std::string element_text(const Cpu& cpu, Area area, std::uint32_t number) {
  const State& state = cpu.state();
  const auto bit = [&](std::uint32_t bits) { return state.image[bits + number / 8] >> number % 8 & 1; };
  switch (area) {
    case Area::T:
      return fmt::format("bit {}, preset {}, counts {}", bit(image::kTBits), state.timer[number].preset,
                         format_duration(timer_base(number).base));
    case Area::C:
      return fmt::format("bit {}{}", bit(image::kCBits), counter_preset_text(cpu, number));
    case Area::HC:
      return counter_text(state.counter[number]);
    default:
      return {};
  }
}

}  // namespace s7200::tools
