// A simulated PLC of another make, as the command line names it.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "serial_sim/westinghouse/plcs.hpp"

namespace s7200::tools {

/// A PLC of this model, set as `settings`, the values of --plc, say. Throws std::invalid_argument if there is none that
/// speaks the protocol of the row, or it has no such setting.
std::unique_ptr<westinghouse::Plc> make_other_plc(const westinghouse::PlcRow& row, std::string_view model,
                                                  const std::vector<std::string>& settings);

/// The same by the name of a protocol that there is.
std::unique_ptr<serial::Automaton> make_other_plc(std::string_view protocol, std::string_view model,
                                                  const std::vector<std::string>& settings);

}  // namespace s7200::tools
