#include "tools/views/state/port_mode.hpp"

#include <fmt/format.h>

#include "interpreter/model/ports.hpp"

namespace s7200::tools {

std::string why_no_freeport(const Cpu& cpu, std::uint8_t port) {
  const State& state = cpu.state();
  if (state.port[port].active) return {};
  const std::uint32_t control = kPorts[port].control;
  return fmt::format("the program has not switched port {} to Freeport mode (SMB{} = 16#{:02X})", port, control - image::kSM,
                     state.image[control]);
}

}  // namespace s7200::tools
