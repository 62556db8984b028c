// set: memory and inputs.
#include "tools/scenario/reading/memory_values.hpp"
#include "tools/scenario/run.hpp"
#include "tools/scenario/steps/steps.hpp"
#include "tools/scenario/transcripts/transcript_writer.hpp"
#include "tools/views/state/memory.hpp"

namespace s7200::tools {
namespace {

struct SetStep final : StepAction {
  std::vector<Assignment> assignments{};

  Needs needs() const override { return Needs::ToChange; }

  /// A programming device does not reach a PLC without power.
  void act(Run& run) const override {
    if (!run.plant()->has_power())
      return run.add(
          {.what = "set", .expected = "a PLC with power", .found = "it has none: nothing was set", .of_run = true});
    run.plant()->act(SetMemory{assignments});
  }

  bool write(TranscriptWriter& writer) const override {
    writer.step("set: " + assignments_text(assignments));
    return true;
  }
};

}  // namespace

std::shared_ptr<const StepAction> read_set(const StepSource& source) {
  auto step = std::make_shared<SetStep>();
  if (source.is.is_map() && source.is.keys.empty())
    source.values.wrong(source.is, "nothing to set", "write for example {VW20: 16#1234, I0.3: 1}");
  step->assignments = read_assignments(source.values, source.is, source.addresses());
  return step;
}

}  // namespace s7200::tools
