#include "tools/views/hppc_text.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>

#include "serial_sim/line/frame.hpp"
#include "serial_sim/westinghouse/hppc_message.hpp"

namespace s7200::tools {

std::string hppc_parameters_text(std::span<const std::uint8_t> operands) {
  constexpr std::size_t kAddress = 3;
  const auto table = operands.subspan(kAddress);
  std::string text = fmt::format("parameter table at 16#{:05X}", westinghouse::hppc_address(operands));
  if (const auto found = westinghouse::holding_registers(table))
    text += fmt::format(", holding register 1 at 16#{:05X}", found->base);
  return table.empty() ? text : fmt::format("{}: {}", text, serial::to_hex(table));
}

std::string hppc_status_text(std::uint8_t status) {
  constexpr std::array<std::string_view, 5> kBits{"special function data valid", "network not found", "controlled by an MCR",
                                                  "controlled by a skip", "processor not running"};
  std::string text = fmt::format("status 16#{:02X}", status);
  std::string_view separator = ": ";
  for (std::size_t bit = 0; bit < kBits.size(); ++bit) {
    if ((status >> bit & 1) == 0) continue;
    text.append(separator).append(kBits[bit]);
    separator = ", ";
  }
  return text;
}

}  // namespace s7200::tools
