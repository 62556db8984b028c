// fatal: the fatal error there must have been.
#include "tools/scenario/run.hpp"
#include "tools/scenario/steps/expected/error_code.hpp"
#include "tools/scenario/steps/steps.hpp"

namespace s7200::tools {
namespace {

std::string text_of(std::uint16_t code) {
  return code == 0 ? "none" : fmt::format("{:04X}, {}", code, meaning_of(FatalError{code}));
}

struct FatalStep final : StepAction {
  std::uint16_t code = 0;  ///< 0: none

  Needs needs() const override { return Needs::ToLook; }

  void act(Run& run) const override {
    run.count_check();
    const std::uint16_t found = run.plant()->cpu().state().fatal_code;
    if (code != 0) run.expect_mode(Mode::Stop);
    if (found != code) run.add({.what = "fatal error", .expected = text_of(code), .found = text_of(found)});
  }
};

}  // namespace

std::shared_ptr<const StepAction> read_fatal(const StepSource& source) {
  auto step = std::make_shared<FatalStep>();
  step->code = read_error_code(source.values, source.is, true).value_or(std::uint16_t{0});
  return step;
}

}  // namespace s7200::tools
