#include "tools/session/past/line_stations.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace s7200::tools {

std::string_view kind_text(LineStation::Kind kind) {
  switch (kind) {
    case LineStation::Kind::Plc:
      return "a PLC";
    case LineStation::Kind::Poller:
      return "a master that polls";
    case LineStation::Kind::Responder:
      return "a peer that answers";
    case LineStation::Kind::Bridge:
      return "a bridge";
  }
  return {};
}

const LineStation* find_station(const std::vector<LineStation>& stations, const serial::SharedLine& line,
                                std::string_view name) {
  const auto is_it = [&](const LineStation& one) {
    return one.line == &line && (one.name == name || fmt::format("{}.{}", one.name, one.port) == name);
  };
  const auto found = std::ranges::find_if(stations, is_it);
  return found == stations.end() ? nullptr : &*found;
}

std::string names_on(const std::vector<LineStation>& stations, const serial::SharedLine& line) {
  std::string names;
  for (const LineStation& one : stations)
    if (one.line == &line && !one.name.empty()) names.append(names.empty() ? "" : ", ").append(one.name);
  return names;
}

}  // namespace s7200::tools
