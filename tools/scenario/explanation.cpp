#include "tools/scenario/explanation.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "tools/host/interruption.hpp"
#include "tools/scenario/plant.hpp"
#include "tools/session/causes/latency_cause.hpp"
#include "tools/session/causes/memory_cause.hpp"
#include "tools/session/causes/unanswered_causes.hpp"

namespace s7200::tools {
namespace {

bool is_about_an_answer(const Finding& finding) { return finding.exchange && !finding.exchange->request.empty(); }

bool is_about_a_time(const Finding& finding) {
  return finding.what == "latency" && finding.exchange && !finding.exchange->response.empty();
}

/// Nothing after an interruption.
std::optional<std::vector<std::string>> reasons_of(History& history, Time timeout, const Finding& finding) {
  if (finding.memory) return memory_cause(history, finding.station, *finding.memory, &interruption());
  if (is_about_a_time(finding)) return latency_cause(history, finding.station, *finding.exchange, &interruption());
  if (!is_about_an_answer(finding)) return {};
  return causes_of_no_answer(history, finding.station, serial::bytes_of(finding.exchange->request), timeout,
                             &interruption());
}

}  // namespace

void explain(const Scenario& scenario, const std::shared_ptr<const Program>& program, ScenarioResult& result) {
  const std::size_t shown = std::min(kFindingsShown, result.findings.size());
  for (std::size_t power_up = 0; power_up < result.recordings.size() && !interrupted(); ++power_up) {
    const auto is_here = [&](const Finding& finding) { return finding.place && finding.place->power_up == power_up; };
    if (std::none_of(result.findings.begin(), result.findings.begin() + static_cast<std::ptrdiff_t>(shown), is_here))
      continue;
    const std::unique_ptr<Plant> plant = new_plant(scenario, program);
    History::Settings settings = plant->history_settings();
    settings.stop_request = &interruption();
    History history(plant->stations(), std::move(settings));
    if (!history.replay(result.recordings[power_up])) continue;
    for (std::size_t i = 0; i < shown; ++i) {
      Finding& finding = result.findings[i];
      if (!is_here(finding)) continue;
      history.go_to(finding.place->moment);
      finding.why = reasons_of(history, scenario.line.timeout, finding).value_or(std::vector<std::string>());
    }
  }
}

}  // namespace s7200::tools
