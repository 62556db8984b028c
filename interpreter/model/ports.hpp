// The serial ports, as data: what the program sees of each (facts 2).
#pragma once

#include <array>
#include <cstdint>

#include "interpreter/model/errors.hpp"
#include "interpreter/model/events.hpp"
#include "interpreter/model/special_memory.hpp"

namespace s7200 {

struct PortInfo {
  std::uint32_t control;         ///< place of its control byte in the image
  sm::InterruptStatus idle;      ///< its bit in SMB4: transmitter idle
  event::Number received, sent;  ///< a character has been received; the transmission is complete
  RunError busy;                 ///< XMT cannot be executed now
};

/// By port number. SMB2 and SM3.0 serve all of them. Port 1 is not modelled: the checker refuses it.
inline constexpr std::array<PortInfo, 1> kPorts{{
    {sm::kPort0Control, sm::kPort0Idle, event::kPort0Received, event::kPort0Sent, RunError::Port0Busy},
}};

}  // namespace s7200
