#include "tools/bridge/mix_up.hpp"

#include <fmt/format.h>

#include "interpreter/base/ppi_frame.hpp"
#include "serial_sim/modbus/mbap.hpp"
#include "serial_sim/modbus/rtu_stream.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools {

std::string mix_up(std::span<const std::uint8_t> bytes, const State* state, std::size_t port) {
  if (modbus::is_tcp_request(bytes))
    return "a client sends Modbus TCP, and this bridge carries the bytes of a serial line: --modbus-tcp is the gateway for "
           "it";
  const bool is_ppi = bytes.size() > 1 && (ppi::body_of(bytes) || ppi::token_of(bytes));
  if (is_ppi && (!state || !state->port[port].active)) return {};
  if (is_ppi)
    return fmt::format(
        "a client speaks PPI, and port {} is in Freeport mode, where the program alone decides what is "
        "answered ({})",
        port, control_byte_text(*state, port));
  if (modbus::lacks_crc(bytes))
    return "what a client sends would be a Modbus request, but it lacks its CRC: a master of Modbus RTU appends two bytes";
  return {};
}

bool is_sending(const State& state, std::size_t port) {
  return state.port[port].transmitting || state.ppi[port].sending > 0;
}

}  // namespace s7200::tools
