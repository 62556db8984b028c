// A rig as a History sees it: each PLC from one of its ports, with the line there and whoever asks on it.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "tools/rig/rig.hpp"
#include "tools/session/past/history.hpp"

namespace s7200::tools {

class SeenRig {
 public:
  /// `asked`: where masters ask. Each of their lines is seen from a PLC on it, unless all of those look at other lines.
  SeenRig(Rig& rig, const std::vector<Spot>& asked);

  /// By PLC. They live as long as this.
  std::vector<serial::Simulation*> stations() const;

  /// The PLC from which a line is seen; nothing if none is.
  std::optional<std::size_t> station_on(std::size_t line) const;

 private:
  std::vector<Spot> spots_;  // by PLC
  std::vector<std::unique_ptr<serial::Simulation>> simulations_;
};

/// The stations of all lines, in the order of the system file.
std::vector<LineStation> line_stations(Rig& rig);

/// Through which something may come in: the port beside a master that has joined at the first spot, then the bridges of the plan.
std::vector<serial::HostPort*> hosts_of(Rig& rig);

/// What a history knows of a rig by name: its PLCs, masters that poll, and what its system file has planned. It drives and
/// records nothing.
History::Settings history_settings(Rig& rig);

}  // namespace s7200::tools
