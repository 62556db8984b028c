// errors: the run-time errors since power-up, these and no others.
#include <map>

#include "interpreter/base/text/text.hpp"
#include "tools/scenario/run.hpp"
#include "tools/scenario/steps/expected/error_code.hpp"
#include "tools/scenario/steps/steps.hpp"
#include "tools/views/report.hpp"

namespace s7200::tools {
namespace {

struct ErrorsStep final : StepAction {
  struct Error {
    std::uint16_t code = 0;
    Count count{};
  };
  std::vector<Error> errors{};

  Needs needs() const override { return Needs::ToLook; }

  void act(Run& run) const override {
    run.count_check();
    const Cpu& cpu = run.plant()->cpu();
    std::map<std::uint16_t, std::uint64_t> found;
    for (const RuntimeError& error : cpu.state().errors)
      if (error.count > 0) found[error.code] += error.count;
    bool right = true;
    for (const Error& error : errors) {
      right &= error.count.has(found[error.code]);
      found.erase(error.code);
    }
    if (right && found.empty()) return;
    std::string expected;
    for (const Error& error : errors)
      expected += fmt::format("{}{:04X}: {}", expected.empty() ? "" : ", ", error.code, in_words(error.count));
    const std::string all = errors_text(cpu);
    run.add(
        {.what = "run-time errors", .expected = expected.empty() ? "none" : expected, .found = all.empty() ? "none" : all});
  }
};

}  // namespace

std::shared_ptr<const StepAction> read_errors(const StepSource& source) {
  auto step = std::make_shared<ErrorsStep>();
  const YamlNode& is = source.is;
  if (is.is_scalar() && stl::lower_case(is.text) == "none") return step;
  if (!is.is_map())
    source.values.wrong(is, "run-time errors are a map or 'none', not " + to_text(is), "write for example {0092: 3}");
  for (std::size_t i = 0; i < is.keys.size() && i < is.items.size(); ++i)
    if (const auto error = read_error_code(source.values, is.keys[i], false))
      step->errors.push_back({*error, source.values.count(is.items[i])});
  return step;
}

}  // namespace s7200::tools
