// Tells which faults can be those of one station of a line.
#pragma once

#include <optional>
#include <string>

#include "serial_sim/faults/fault.hpp"

namespace s7200::tools {

struct NotOfStation {
  std::string wrong, hint;
  const serial::GivenParameter* given = nullptr;  ///< the parameter that is wrong; null: it is the station
};

/// Why a fault cannot be that of a station that is named beside it; nothing if it can. `is_plc`: an S7-200.
std::optional<NotOfStation> why_not_of_station(const serial::ParsedFault& fault, bool is_plc);

}  // namespace s7200::tools
