#include "tools/mutants/mutants_report.hpp"

#include <fmt/format.h>

#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/coverage/coverage_report.hpp"
#include "tools/coverage/programs.hpp"
#include "tools/views/inspection/inspection.hpp"

namespace s7200::tools {

namespace {

std::string share_text(const MutantsOfProgram& mutants) {
  if (mutants.mutants == 0 && mutants.not_tried > 0) return "interrupted before the first change was tried";
  const double percent =
      mutants.mutants == 0 ? 100 : 100 * static_cast<double>(mutants.noticed) / static_cast<double>(mutants.mutants);
  return fmt::format("{} of {} noticed by {}, {:.1f}%{}", mutants.noticed, mutants.mutants,
                     counted(mutants.scenarios, "scenario"), percent,
                     mutants.not_tried > 0 ? ", when it was interrupted" : "");
}

}  // namespace

std::string mutants_text(const MutantsOfProgram& mutants) {
  const Inspection inspection = for_places(mutants.program);
  std::string text = fmt::format("mutants of {}, CPU {}\n  {}\n", stl::printable(coverage_name(*mutants.program)),
                                 mutants.program->model->name, share_text(mutants));
  if (!mutants.survivors.empty()) text += "not noticed:\n";
  for (const Survivor& each : mutants.survivors)
    text += row_text(inspection, "  ", each.mutation.op) + "        " +
            wrapped_at(stl::printable(each.mutation.what + (each.tried ? "" : "; no scenario comes to it")), 8, 8) + "\n";
  return text;
}

nlohmann::ordered_json mutants_json(const MutantsOfProgram& mutants) {
  const Inspection inspection = for_places(mutants.program);
  nlohmann::ordered_json json{{"program", coverage_name(*mutants.program)},
                              {"cpu", mutants.program->model->name},
                              {"scenarios", mutants.scenarios},
                              {"mutants", mutants.mutants},
                              {"noticed", mutants.noticed},
                              {"same", mutants.same},
                              {"refused", mutants.refused},
                              {"not_tried", mutants.not_tried},
                              {"survivors", nlohmann::ordered_json::array()}};
  for (const Survivor& each : mutants.survivors) {
    nlohmann::ordered_json one = place_json(inspection, each.mutation.op);
    one["change"] = each.mutation.what;
    one["tried"] = each.tried;
    json["survivors"].push_back(std::move(one));
  }
  return json;
}

}  // namespace s7200::tools
