// The simulated PLCs of this family: one row for each protocol.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/result.hpp"
#include "serial_sim/westinghouse/plc.hpp"

namespace s7200::westinghouse {

/// A protocol, and the models that speak it.
struct PlcRow {
  std::string_view name;  ///< of the protocol, as `s7200 master --protocol` has it: `pc1000-lan`
  std::vector<std::string_view> models;
  std::unique_ptr<Plc> (*make)();          ///< in its bench state
  std::vector<std::string> (*settings)();  ///< with defaults and meaning, for the help
};

std::span<const PlcRow> plcs();

/// Returns null if no PLC has this protocol.
const PlcRow* find_plc(std::string_view protocol);

/// A model that speaks the protocol, in its bench state. Trouble if it does not.
Result<std::unique_ptr<Plc>> make_plc(const PlcRow& row, std::string_view model);

/// The settings with their defaults and what they mean, one a line.
std::string settings_help(const PlcRow& row);

}  // namespace s7200::westinghouse
