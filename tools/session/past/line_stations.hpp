// The stations of the lines: PLCs, and the peers and bridges that have no program to step through.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "serial_sim/system/shared_line.hpp"

namespace s7200::tools {

/// One on a line; a PLC for each of its ports.
struct LineStation {
  enum class Kind : std::uint8_t { Plc, Poller, Responder, Bridge };

  Kind kind{};
  std::string name{};      ///< empty: it is the only PLC
  std::size_t number = 0;  ///< of a PLC, in the order of the system
  std::uint8_t port = 0;   ///< of a PLC
  serial::SharedLine* line = nullptr;
  std::string line_name{};
  int driver = 0;
};

/// `a master that polls`
std::string_view kind_text(LineStation::Kind kind);

/// The one on a line that is called so, `slave2` or `gateway.1`; null if there is none.
const LineStation* find_station(const std::vector<LineStation>& stations, const serial::SharedLine& line,
                                std::string_view name);

/// `slave1, slave2`
std::string names_on(const std::vector<LineStation>& stations, const serial::SharedLine& line);

}  // namespace s7200::tools
