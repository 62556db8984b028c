#include "tools/plan/fault_owner.hpp"

#include <fmt/format.h>

namespace s7200::tools {
namespace {

/// The parameter that names a fault's station, as the station beside the fault does; null if there is none.
const serial::GivenParameter* whose(const serial::ParsedFault& fault) {
  if (fault.fault.kind == serial::FaultKind::Answer) return nullptr;  // its 'station' is in the frame
  const serial::GivenParameter* const of = fault.find("of");
  return of ? of : fault.find("station");
}

}  // namespace

std::optional<NotOfStation> why_not_of_station(const serial::ParsedFault& fault, bool is_plc) {
  if (!serial::is_of_a_station(fault.fault))
    return NotOfStation{"noise, and a fault at an instant, are of the line and not of a station", "leave the station out"};
  if (const serial::GivenParameter* const given = whose(fault))
    return NotOfStation{fmt::format("'{}=' says whose it is, and so does 'station' beside it", given->name),
                        fmt::format("leave '{}=' out", given->name), given};
  if (fault.fault.kind == serial::FaultKind::Echo && is_plc)
    return NotOfStation{"the port of an S7-200 does not hear what it sends", "an echo is of a peer or a bridge"};
  return {};
}

}  // namespace s7200::tools
