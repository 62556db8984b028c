#include "tools/debugger/counter_preset.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/bytes.hpp"

namespace s7200::tools {

std::string counter_preset_text(const Cpu& cpu, std::uint32_t number) {
  const std::vector<Op>& ops = cpu.program().ops;
  const std::uint32_t at = info(Area::C).base + number * info(Area::C).step();
  const auto counts =
      std::ranges::find_if(ops, [&](const Op& op) { return op.instruction->mnemonic.starts_with("CT") && op[0].at == at; });
  const auto preset = counts == ops.end() ? std::nullopt : cpu.place_of((*counts)[1]);
  return preset ? fmt::format(", preset {}", static_cast<std::int16_t>(load16(&cpu.state().image[*preset]))) : "";
}

}  // namespace s7200::tools
