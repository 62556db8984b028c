#include "tools/trials/trial_scenario.hpp"

#include <fmt/format.h>

#include "interpreter/analysis/memory_names.hpp"
#include "serial_sim/line/frame.hpp"
#include "tools/scenario/reader.hpp"
#include "tools/scenario/report.hpp"
#include "tools/scenario/runner.hpp"
#include "tools/scenario/transcript_writer.hpp"

namespace s7200::tools {
namespace {

/// `{I0.1: 1, I0.3: 0}`: the points that are others than before.
std::string inputs_text(const Stimulus& input, std::uint8_t before) {
  std::string text;
  for (unsigned bit = 0; bit < 8; ++bit) {
    if (((before ^ input.bytes.front()) >> bit & 1) == 0) continue;
    text += fmt::format("{}I{}.{}: {}", text.empty() ? "" : ", ", input.place, bit, input.bytes.front() >> bit & 1);
  }
  return text;
}

std::string memory_assignment(const Stimulus& memory) {
  std::uint32_t value = 0;
  for (const std::uint8_t byte : memory.bytes) value = value << 8 | byte;
  return fmt::format("{}: {}", place_text(memory.place, memory.bytes.size()), value);
}

std::string hex(const std::vector<std::uint8_t>& bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) text += fmt::format("{}{:02x}", text.empty() ? "" : " ", byte);
  return text;
}

}  // namespace

std::string place_text(std::uint32_t place, std::size_t bytes) { return memory_text({place * 8u, bytes * 8u}); }

std::string scenario_text(const TrialScenario& scenario, const Program& program) {
  std::string text = fmt::format("name: {}\nprogram: {}\ncpu: \"{}\"\n", in_quotes(scenario.name),
                                 in_quotes(scenario.origin.program), program.model->name);
  for (const std::string& file : scenario.origin.with)
    text += fmt::format("{}  - {}\n", &file == scenario.origin.with.data() ? "with:\n" : "", in_quotes(file));
  text += scenario.origin.head;
  if (scenario.port != 0) text += fmt::format("port: {}\n", scenario.port);
  text += "after: 0 ms\nsteps:\n";
  std::array<std::uint8_t, image::kPointBytes> inputs{};
  for (std::size_t i = 0; i < scenario.trial.size(); ++i) {
    const Stimulus& stimulus = scenario.trial[i];
    if (stimulus.what == Stimulus::What::Frame) {
      text += fmt::format("  - send: {}\n    at: {}\n    timeout: {}\n", hex(stimulus.bytes), exact(scenario.begun[i]),
                          exact(kPatience));
      if (stimulus.gap != 0) text += fmt::format("    gap: {}\n", exact(stimulus.gap));
      if (i < scenario.beside.size() && !scenario.beside[i].empty()) text += fmt::format("    {}\n", scenario.beside[i]);
      continue;
    }
    const bool input = stimulus.what == Stimulus::What::Input;
    const std::string set = input ? inputs_text(stimulus, inputs[stimulus.place]) : memory_assignment(stimulus);
    if (input) inputs[stimulus.place] = stimulus.bytes.front();
    text += fmt::format("  - wait: until {}\n", exact(scenario.begun[i]));
    if (!set.empty()) text += fmt::format("  - set: {{{}}}\n", set);
  }
  return text + scenario.end;
}

std::optional<std::vector<std::string>> findings_of(const std::string& text, const std::string& path,
                                                    const std::shared_ptr<const Program>& program, std::string& why) {
  const ScenarioFile file = read_scenarios(text, path);
  if (!file.diagnostics.empty() || file.scenarios.size() != 1) {
    why = file.diagnostics.empty() ? "it has no steps" : file.diagnostics.front().message;
    return {};
  }
  const ScenarioResult result = run_scenario(file.scenarios.front(), {.program = program});
  std::vector<std::string> findings;
  for (const Finding& finding : result.findings) {
    if (finding.of_run) {
      why = finding_line(file.scenarios.front(), finding);
      return {};
    }
    findings.push_back(finding_line(file.scenarios.front(), finding));
  }
  return findings;
}

}  // namespace s7200::tools
