#include "tools/scenario/reporting/explanation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "tools/scenario/plant.hpp"
#include "tools/session/causes/latency_cause.hpp"
#include "tools/session/causes/line/unanswered_causes.hpp"
#include "tools/session/causes/memory_cause.hpp"
#include "tools/session/past/actions/journal.hpp"

namespace s7200::tools {
namespace {

bool is_about_an_answer(const Finding& finding) { return finding.exchange && !finding.exchange->request.empty(); }

bool is_about_a_time(const Finding& finding) {
  return finding.what == "latency" && finding.exchange && !finding.exchange->response.empty();
}

bool can_have_a_cause(const Finding& finding) {
  return finding.memory || is_about_a_time(finding) || is_about_an_answer(finding);
}

/// A run is written down up to so many requests and changes, so what was found later has no place in it.
bool is_after_the_journal(const Finding& finding, const std::vector<Recording>& recordings) {
  const auto is_full = [](const Recording& run) { return run.actions.size() >= Journal::kMostActions; };
  return !finding.place && can_have_a_cause(finding) && std::ranges::any_of(recordings, is_full);
}

/// The reasons for a finding; nothing if a stop was asked for meanwhile.
std::optional<std::vector<std::string>> reasons_of(History& history, Time timeout, const Finding& finding, StopToken stop) {
  if (finding.memory) return memory_cause(history, finding.station, *finding.memory, stop);
  if (is_about_a_time(finding)) return latency_cause(history, finding.station, *finding.exchange, stop);
  if (!is_about_an_answer(finding)) return {};
  const auto causes =
      causes_of_no_answer(history, finding.station, serial::bytes_of(finding.exchange->request), timeout, stop);
  return causes ? std::optional(texts_of(*causes)) : std::nullopt;
}

}  // namespace

void explain(const Scenario& scenario, const std::shared_ptr<const Program>& program, StopToken stop,
             ScenarioResult& result) {
  const std::size_t shown = std::min(kFindingsShown, result.findings.size());
  for (std::size_t i = 0; i < shown; ++i)
    if (is_after_the_journal(result.findings[i], result.recordings))
      result.findings[i].why = {
          fmt::format("the cause is not known: it came after the first {} requests and changes of the "
                      "run, and only these are written down",
                      Journal::kMostActions)};
  for (std::size_t power_up = 0; power_up < result.recordings.size() && !stop.stop_requested(); ++power_up) {
    const auto is_here = [&](const Finding& finding) { return finding.place && finding.place->power_up == power_up; };
    if (std::none_of(result.findings.begin(), result.findings.begin() + static_cast<std::ptrdiff_t>(shown), is_here))
      continue;
    const auto plant = std::make_unique<Plant>(scenario, program, stop);
    History::Settings settings = plant->history_settings();
    settings.stop_request = stop;
    History history(plant->stations(), std::move(settings));
    if (!history.replay(result.recordings[power_up])) continue;
    for (std::size_t i = 0; i < shown; ++i) {
      Finding& finding = result.findings[i];
      if (!is_here(finding)) continue;
      history.go_to(finding.place->moment);
      finding.why = reasons_of(history, scenario.line.timeout, finding, stop).value_or(std::vector<std::string>());
    }
  }
}

}  // namespace s7200::tools
