#include "tools/scenario/explanation.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/trace/statement_text.hpp"
#include "tools/host/interruption.hpp"
#include "tools/scenario/plant.hpp"
#include "tools/session/causes/last_decision.hpp"
#include "tools/session/causes/last_write.hpp"
#include "tools/session/causes/writer.hpp"
#include "tools/session/past/past_words.hpp"
#include "tools/views/listing.hpp"
#include "tools/views/machine_text.hpp"

namespace s7200::tools {
namespace {

bool is_about_an_answer(const Finding& finding) { return finding.exchange && !finding.exchange->request.empty(); }

/// `last written at 2100.000000 ms by = Q0.1 in line 42`
std::string last_write_text(History& history, const Program& program, const MemoryRange& range) {
  const WriteSearch search = find_last_write(history, 0, range, &interruption());
  if (search.interrupted) return {};
  if (!search.write) return fmt::format("nothing has written it {}", since_oldest_text(history));
  const LastWrite& write = *search.write;
  const std::string by =
      write.by ? named_in_sentence(write.by->op, program) : changer_text(history, write.action, write.planned);
  return fmt::format("last written at {} by {}", moment_text(write.at), by);
}

std::vector<std::string> reasons_of(History& history, const Program& program, Time timeout, const Finding& finding) {
  if (finding.memory) return {last_write_text(history, program, *finding.memory)};
  if (!is_about_an_answer(finding)) return {};
  const DecisionSearch search = find_last_decision(history, 0, timeout, &interruption());
  if (search.interrupted || search.unanswered.empty()) return {};
  return to_lines(search, Listing(program));
}

}  // namespace

void explain(const Scenario& scenario, const std::shared_ptr<const Program>& program, ScenarioResult& result) {
  const std::size_t shown = std::min(kFindingsShown, result.findings.size());
  for (std::size_t power_up = 0; power_up < result.recordings.size() && !interrupted(); ++power_up) {
    const auto is_here = [&](const Finding& finding) { return finding.place && finding.place->power_up == power_up; };
    if (std::none_of(result.findings.begin(), result.findings.begin() + static_cast<std::ptrdiff_t>(shown), is_here))
      continue;
    Plant plant(scenario, program);
    History history(plant.simulation(), {.stop_request = &interruption()});
    if (!history.replay(result.recordings[power_up])) continue;
    for (std::size_t i = 0; i < shown; ++i) {
      Finding& finding = result.findings[i];
      if (!is_here(finding)) continue;
      history.go_to(finding.place->moment);
      finding.why = reasons_of(history, *program, scenario.line.timeout, finding);
    }
  }
}

}  // namespace s7200::tools
