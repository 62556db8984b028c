// Who asks on a line.
#pragma once

#include <cstddef>
#include <cstdint>

#include "serial_sim/peers/requester.hpp"

namespace s7200::tools {

struct Asker {
  enum class Kind : std::uint8_t { Send, Poller, Plc, Bridge } kind{};
  std::size_t number = 0;  ///< of the station; of `send` the first one on its line; in History::pollers(), History::hosts()

  bool operator==(const Asker&) const = default;
};

/// A master in the simulation: that of `send`, or one that polls. What it asks and hears is known. Nothing is owned.
struct SimulatedMaster {
  Asker asker{};
  const serial::Requester* requester = nullptr;
  int driver = 0;                        ///< of the line
  const SerialFormat* format = nullptr;  ///< as it is set now
};

}  // namespace s7200::tools
