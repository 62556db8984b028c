// power_cycle: power off and on again.
#include "tools/scenario/run.hpp"
#include "tools/scenario/steps/steps.hpp"
#include "tools/scenario/transcripts/transcript_writer.hpp"

namespace s7200::tools {
namespace {

struct PowerCycleStep final : StepAction {
  bool memory_lost = false;  ///< power was off for longer than the retentive memory lasts
  Time power_off = 0;        ///< how long it was off: the clock goes on

  Needs needs() const override { return Needs::ToChange; }

  void act(Run& run) const override {
    run.plant()->power_cycle(memory_lost, power_off);
    run.before = {};
    run.forget_delay();
    run.expect_mode({});
    if (!run.plant()->get_ready())
      run.add({.what = "ready", .expected = "the line quiet after power-up", .found = "that never came", .of_run = true});
  }

  bool write(TranscriptWriter& writer) const override {
    writer.step(fmt::format("power_cycle: memory {}", memory_lost ? "lost" : "kept"));
    if (power_off != 0) writer.beside("power_off: " + exact(power_off));
    return true;
  }
};

}  // namespace

std::shared_ptr<const StepAction> read_power_cycle(const StepSource& source) {
  auto step = std::make_shared<PowerCycleStep>();
  ValueReader& values = source.values;
  if (source.scenario.plan)
    values.wrong(source.node, "'power_cycle' is about a program", "power_off and power_on switch one PLC of a system");
  step->memory_lost = values.choice<bool>(&source.is, {{"memory kept", false}, {"memory lost", true}}).value_or(false);
  step->power_off =
      values
          .value(source.beside("power_off"), "a duration", "8h, 72h", [](const std::string& t) { return parse_duration(t); })
          .value_or(0);
  return step;
}

}  // namespace s7200::tools
