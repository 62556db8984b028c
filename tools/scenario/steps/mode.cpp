// mode: RUN or STOP.
#include "tools/scenario/run.hpp"
#include "tools/scenario/steps/steps.hpp"

namespace s7200::tools {
namespace {

std::string text_of(Mode mode) { return mode == Mode::Run ? "RUN" : "STOP"; }

struct ModeStep final : StepAction {
  Mode mode = Mode::Run;

  Needs needs() const override { return Needs::ToLook; }

  void act(Run& run) const override {
    run.count_check();
    run.expect_mode(mode);
    const Mode found = run.plant()->cpu().state().mode;
    if (found != mode)
      run.add({.what = run.plant()->of_plc("mode"),
               .expected = text_of(mode),
               .found = text_of(found) + run.plant()->why_stopped()});
  }
};

}  // namespace

std::shared_ptr<const StepAction> read_mode(const StepSource& source) {
  auto step = std::make_shared<ModeStep>();
  step->mode = source.values.choice<Mode>(&source.is, {{"run", Mode::Run}, {"stop", Mode::Stop}}).value_or(Mode::Run);
  return step;
}

}  // namespace s7200::tools
