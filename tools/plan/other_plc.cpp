#include "tools/plan/other_plc.hpp"

namespace s7200::tools {

Result<std::unique_ptr<westinghouse::Plc>> make_other_plc(const westinghouse::PlcRow& row, std::string_view model,
                                                          const std::vector<std::string>& settings) {
  auto plc = westinghouse::make_plc(row, model);
  if (!plc) return plc;
  for (const bool cells : {false, true})
    for (const std::string& setting : settings) {
      if ((*plc)->names_cells(setting) != cells) continue;
      if (const auto done = (*plc)->set(setting); !done) return trouble("--plc: {}", done.why());
    }
  for (const std::string& setting : settings)
    if (const auto done = (*plc)->still_reaches(setting); !done) return trouble("--plc: {}", done.why());
  return plc;
}

Result<std::unique_ptr<serial::Automaton>> make_other_plc(std::string_view protocol, std::string_view model,
                                                          const std::vector<std::string>& settings) {
  auto plc = make_other_plc(*westinghouse::find_plc(protocol), model, settings);
  if (!plc) return plc.trouble();
  return *std::move(plc);
}

}  // namespace s7200::tools
