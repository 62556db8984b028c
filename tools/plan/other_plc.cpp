#include "tools/plan/other_plc.hpp"

namespace s7200::tools {

std::unique_ptr<westinghouse::Plc> make_other_plc(const westinghouse::PlcRow& row, std::string_view model,
                                                  const std::vector<std::string>& settings, std::string& why) {
  std::unique_ptr<westinghouse::Plc> plc = westinghouse::make_plc(row, model, why);
  if (!plc) return nullptr;
  for (const bool cells : {false, true})
    for (const std::string& setting : settings)
      if (plc->names_cells(setting) == cells && !plc->set(setting, why)) return why.insert(0, "--plc: "), nullptr;
  for (const std::string& setting : settings)
    if (!plc->still_reaches(setting, why)) return why.insert(0, "--plc: "), nullptr;
  return plc;
}

std::unique_ptr<serial::Automaton> make_other_plc(std::string_view protocol, std::string_view model,
                                                  const std::vector<std::string>& settings, std::string& why) {
  return make_other_plc(*westinghouse::find_plc(protocol), model, settings, why);
}

}  // namespace s7200::tools
