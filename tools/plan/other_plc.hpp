// A simulated PLC of another make, as the command line names it.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/result.hpp"
#include "serial_sim/westinghouse/plcs.hpp"

namespace s7200::tools {

/// Makes a PLC of this model with `settings`, which are the values of --plc. Trouble if no PLC of this model speaks
/// the protocol of the row, or if it has no such setting.
Result<std::unique_ptr<westinghouse::Plc>> make_other_plc(const westinghouse::PlcRow& row, std::string_view model,
                                                          const std::vector<std::string>& settings);

/// The same by the name of an existing protocol.
Result<std::unique_ptr<serial::Automaton>> make_other_plc(std::string_view protocol, std::string_view model,
                                                          const std::vector<std::string>& settings);

}  // namespace s7200::tools
