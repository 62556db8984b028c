// The serial ports, as data: what the program sees of each (facts 2). A row is all there is to a port: everything else runs
// over the ports that the model of a CPU has.
#pragma once

#include <array>
#include <cstdint>

#include "interpreter/model/errors.hpp"
#include "interpreter/model/events.hpp"
#include "interpreter/model/special_memory.hpp"

namespace s7200 {

struct PortInfo {
  std::uint32_t control;     ///< place of its control byte in the image
  std::uint32_t message;     ///< place of the status of its receive message service; sm::message has the rest
  sm::InterruptStatus idle;  ///< its bit in SMB4: transmitter idle
  event::Number received, sent, received_message;  ///< a character, all characters of XMT, a message
  RunError busy;                                   ///< XMT or RCV cannot be executed now
};

// clang-format off

/// The ports by number; a CPU has the first CpuModel::ports of them. SMB2 and SM3.0 serve all.
inline constexpr std::array<PortInfo, 2> kPorts{{
    {sm::byte(30),  sm::byte(86),  sm::kPort0Idle, event::kPort0Received, event::kPort0Sent, event::kPort0Message, RunError::Port0Busy},
    {sm::byte(130), sm::byte(186), sm::kPort1Idle, event::kPort1Received, event::kPort1Sent, event::kPort1Message, RunError::Port1Busy},
}};

// clang-format on

/// Whether a port reports a received character with this event.
constexpr bool is_receive_event(std::uint8_t event) {
  for (const PortInfo& port : kPorts)
    if (port.received == event) return true;
  return false;
}

}  // namespace s7200
