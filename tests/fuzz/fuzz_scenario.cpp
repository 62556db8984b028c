// Scenario files: whatever the text is, it is read or refused with messages. What can be read is run, for a bounded
// simulated time, and the transcript of that run is a scenario again, which gives the same.
#include <cstdint>
#include <nlohmann/json.hpp>

#include "interpreter/analysis/warnings/check.hpp"
#include "tests/fuzz/promise.hpp"
#include "tools/scenario/reading/reader.hpp"
#include "tools/scenario/reporting/junit.hpp"
#include "tools/scenario/reporting/report_json.hpp"
#include "tools/scenario/runner.hpp"
#include "tools/scenario/steps/exchange.hpp"
#include "tools/scenario/steps/expected/receive.hpp"
#include "tools/scenario/steps/wait.hpp"
#include "tools/scenario/steps/wait_until.hpp"
#include "tools/scenario/transcripts/transcript.hpp"

namespace {

using namespace s7200;
using namespace s7200::tools;

/// Echoes every character.
const std::shared_ptr<const Program>& echo() {
  static const std::shared_ptr<const Program> kProgram =
      check_text(
          "LD SM0.1\nMOVB 16#09, SMB30\nMOVB 1, VB0\nATCH 0, 8\nENI\nMEND\nINT 0\nLD SM0.0\nMOVB SMB2, VB1\nXMT VB0, "
          "0\nRETI\n",
          "echo.stl", cpu214(), default_times(cpu214()))
          .program;
  return kProgram;
}

void limit(Span& span, Time most) {
  span.fixed = std::min(span.fixed, most);
  span.millicharacters = std::min<std::int64_t>(span.millicharacters, 20'000);
}

void shorten(Reception& reception, Time most) {
  if (reception.listen) limit(*reception.listen, most);
  if (reception.timeout) reception.timeout = std::min(*reception.timeout, most);
}

/// Puts a changed copy into a step of that kind.
template <class Kind, class Change>
void change(Step& step, Change with) {
  const auto* action = dynamic_cast<const Kind*>(step.action.get());
  if (!action) return;
  auto copy = std::make_shared<Kind>(*action);
  with(*copy);
  step.action = std::move(copy);
}

constexpr Time kMost = 20 * kMillisecond;
constexpr std::size_t kMostCharacters = 32;

/// Little is left of a scenario, so that many can be run.
void shorten(Scenario& scenario) {
  if (scenario.steps.size() > 12) scenario.steps.resize(12);
  limit(scenario.pause, kMost);
  scenario.line.timeout = std::min(scenario.line.timeout, kMost);
  scenario.line.baud = std::max<std::uint32_t>(scenario.line.baud.value_or(9600), 9600);
  if (scenario.after != kNever) scenario.after = std::min(scenario.after, kMost);
  for (Step& step : scenario.steps) {
    change<WaitStep>(step, [](WaitStep& wait) {
      limit(wait.time, kMost);
      wait.scans = std::min<std::uint64_t>(wait.scans, 10);
    });
    change<WaitUntilStep>(step, [](WaitUntilStep& wait) {
      if (wait.timeout) wait.timeout = std::min(*wait.timeout, kMost);
    });
    change<ReceiveStep>(step, [](ReceiveStep& receive) { shorten(receive, kMost); });
    change<ExchangeStep>(step, [](ExchangeStep& exchange) {
      shorten(exchange, kMost);
      if (exchange.request.size() > kMostCharacters) exchange.request.resize(kMostCharacters);
      if (exchange.pause) limit(*exchange.pause, kMost);
      limit(exchange.gap, kMillisecond);
      exchange.at.reset();
    });
  }
}

std::string run(const std::vector<Scenario>& scenarios, bool replay) {
  std::vector<Report> reports;
  for (const Scenario& scenario : scenarios) {
    reports.push_back({&scenario, run_scenario(scenario, {.program = echo()})});
    const std::string text = report_text(reports.back(), false);
    if (replay) must(reports.back().result.outcome != ScenarioResult::Outcome::Failed, "a replay differs", text);
  }
  (void)to_junit(reports);
  (void)to_json(reports);
  return transcript_text(reports, {"scenario.yaml", "echo", 0});
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ScenarioFile file = read_scenarios({reinterpret_cast<const char*>(data), size}, "scenario.yaml");
  for (const stl::Diagnostic& diagnostic : file.diagnostics) {
    const std::string text = stl::render(diagnostic, *file.source, false);
    must(text.find("error: ") != std::string::npos, "a diagnostic without a message", text);
  }
  if (!file.diagnostics.empty()) return 0;
  must(!file.scenarios.empty(), "neither scenarios nor mistakes", "");
  if (file.scenarios.size() > 3) file.scenarios.resize(3);
  for (Scenario& scenario : file.scenarios) {
    if (scenario.cpu != "214") return 0;  // of another CPU there may be addresses that this program's has not
    shorten(scenario);
  }
  const std::string transcript = run(file.scenarios, false);
  if (transcript.ends_with("scenarios:\n")) return 0;  // all were skipped
  const ScenarioFile again = read_scenarios(transcript, "scenario.yaml");
  must(again.diagnostics.empty(), "a transcript that cannot be read", transcript);
  must(run(again.scenarios, true) == transcript, "a transcript that changes when it is replayed", transcript);
  return 0;
}
