// set_mode: a programming device asks for RUN or STOP.
#include "tools/scenario/run.hpp"
#include "tools/scenario/steps/steps.hpp"
#include "tools/scenario/transcripts/transcript_writer.hpp"

namespace s7200::tools {
namespace {

struct SetModeStep final : StepAction {
  Mode mode = Mode::Run;

  Needs needs() const override { return Needs::ToChange; }

  void act(Run& run) const override {
    Plant& plant = *run.plant();
    if (!plant.has_power()) return refuse(run, "a PLC with power", "it has none");
    if (plant.cpu().state().fatal_code != 0)
      return refuse(run, "a CPU that can change its mode", "a fatal error keeps it in STOP");
    plant.act(SetMode{mode});
    run.expect_mode(mode == Mode::Stop ? std::optional(mode) : std::nullopt);
  }

  bool write(TranscriptWriter& writer) const override {
    writer.step(mode == Mode::Run ? "set_mode: run" : "set_mode: stop");
    return true;
  }

 private:
  static void refuse(Run& run, std::string expected, std::string found) {
    run.add({.what = "set_mode", .expected = std::move(expected), .found = std::move(found), .of_run = true});
  }
};

}  // namespace

std::shared_ptr<const StepAction> read_set_mode(const StepSource& source) {
  auto step = std::make_shared<SetModeStep>();
  step->mode = source.values.choice<Mode>(&source.is, {{"run", Mode::Run}, {"stop", Mode::Stop}}).value_or(Mode::Run);
  return step;
}

}  // namespace s7200::tools
