// power_off, power_on, cut, mend: what happens to a system in the field.
#include "tools/rig/system_reader.hpp"
#include "tools/scenario/run.hpp"
#include "tools/scenario/steps/steps.hpp"
#include "tools/scenario/transcript_writer.hpp"

namespace s7200::tools {
namespace {

struct EventOfSystemStep final : Action {
  EventPlan event{};
  std::string written{}, after{};  ///< `power_off: slave2`; the last station before a cut

  Needs needs() const override { return Needs::ToChange; }

  void act(Run& run) const override { run.plant()->carry_out(event); }

  bool write(TranscriptWriter& writer) const override {
    writer.step(written);
    if (!after.empty()) writer.beside("after: " + after);
    return true;
  }
};

}  // namespace

std::shared_ptr<const Action> read_event_of_system(const StepSource& source) {
  auto step = std::make_shared<EventOfSystemStep>();
  if (!source.scenario.plan) {
    source.values.wrong(source.node, "only a system has several PLCs and lines",
                        "name its file with 'system:', not 'program:'");
    return step;
  }
  if (const auto event = read_event(source.node, *source.scenario.plan, source.values)) step->event = *event;
  for (const char* const key : {"power_off", "power_on", "cut", "mend"})
    if (const auto name = source.values.optional_text(source.node, key)) step->written = fmt::format("{}: {}", key, *name);
  step->after = source.values.optional_text(source.node, "after").value_or("");
  return step;
}

}  // namespace s7200::tools
