#include "tools/trials/trial_scenario.hpp"

#include <fmt/format.h>

#include "interpreter/analysis/effects/memory_names.hpp"
#include "serial_sim/line/frame.hpp"
#include "tools/scenario/reading/reader.hpp"
#include "tools/scenario/reporting/report.hpp"
#include "tools/scenario/runner.hpp"
#include "tools/scenario/transcripts/transcript_writer.hpp"

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

/// The steps of one stimulus. `at`: when, since power came; `before`: the levels of its input byte.
std::string steps_of(const Stimulus& stimulus, Time at, std::uint8_t before) {
  using What = Stimulus::What;
  if (stimulus.what == What::Frame) {
    std::string text =
        fmt::format("  - send: {}\n    at: {}\n    timeout: {}\n", frame_text(stimulus), exact(at), exact(kPatience));
    if (stimulus.gap != 0) text += fmt::format("    gap: {}\n", exact(stimulus.gap));
    if (!stimulus.bad_stop) return text;
    return fmt::format("  - fault: framing:character={}\n{}  - fault: none\n", stimulus.damaged, text);
  }
  std::string text = fmt::format("  - wait: until {}\n", exact(at));
  if (stimulus.what == What::Power) return text + "  - power_cycle: memory kept\n";
  if (stimulus.what == What::Break)
    return text +
           fmt::format("  - fault: break:from=0s,length={}\n  - wait: {}\n  - fault: none\n", exact(kBreak), exact(kBreak));
  const std::string set = stimulus.what == What::Input ? inputs_text(stimulus, before) : memory_assignment(stimulus);
  return set.empty() ? text : text + fmt::format("  - set: {{{}}}\n", set);
}

}  // namespace

std::string frame_text(const Stimulus& frame) {
  serial::Frame characters = serial::to_frame(frame.bytes);
  if (!frame.bad_stop && frame.damaged != 0 && frame.damaged <= characters.size())
    characters[frame.damaged - 1u].wrong_parity = true;
  return serial::to_hex(characters);
}

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
  Time powered_up_at = 0;
  for (std::size_t i = 0; i < scenario.trial.size(); ++i) {
    const Stimulus& stimulus = scenario.trial[i];
    const bool input = stimulus.what == Stimulus::What::Input;
    text += steps_of(stimulus, scenario.begun[i] - powered_up_at, input ? inputs[stimulus.place] : 0);
    if (input) inputs[stimulus.place] = stimulus.bytes.front();
    if (stimulus.what == Stimulus::What::Power) powered_up_at = scenario.begun[i];
    if (i < scenario.beside.size() && !scenario.beside[i].empty()) text += fmt::format("    {}\n", scenario.beside[i]);
  }
  return text + scenario.end;
}

Result<std::vector<std::string>> findings_of(const std::string& text, const std::string& path,
                                             const std::shared_ptr<const Program>& program) {
  const ScenarioFile file = read_scenarios(text, path);
  if (!file.diagnostics.empty() || file.scenarios.size() != 1)
    return Trouble{file.diagnostics.empty() ? "it has no steps" : file.diagnostics.front().message};
  const ScenarioResult result = run_scenario(file.scenarios.front(), {.program = program});
  std::vector<std::string> findings;
  for (const Finding& finding : result.findings) {
    if (finding.of_run) return Trouble{finding_line(file.scenarios.front(), finding)};
    findings.push_back(finding_line(file.scenarios.front(), finding));
  }
  return findings;
}

}  // namespace s7200::tools
