// fault: a fault of the line from now on, or none any more.
#include "serial_sim/faults/fault.hpp"

#include "interpreter/base/text.hpp"
#include "tools/scenario/run.hpp"
#include "tools/scenario/steps/steps.hpp"
#include "tools/scenario/transcript_writer.hpp"

namespace s7200::tools {
namespace {

struct FaultStep final : Action {
  std::optional<serial::Fault> fault{};

  Needs needs() const override { return Needs::ToChange; }

  void act(Run& run) const override {
    if (fault)
      run.plant()->simulation().inject(*fault);
    else
      run.plant()->simulation().clear_faults();
  }

  bool write(TranscriptWriter& writer) const override {
    writer.step("fault: " + (fault ? serial::to_text(*fault) : "none"));
    return true;
  }
};

}  // namespace

std::shared_ptr<const Action> read_fault(const StepSource& source) {
  auto step = std::make_shared<FaultStep>();
  const auto written = source.values.text(source.is);
  if (!written || stl::lower_case(*written) == "none") return step;
  serial::ParsedFault parsed = serial::parse_fault(*written);
  if (parsed.ok()) {
    step->fault = std::move(parsed.fault);
    return step;
  }
  YamlNode place = source.is;
  if (*written == source.is.text) {
    place.position.column += static_cast<std::uint32_t>(parsed.error->column - 1);
    place.position.length = static_cast<std::uint32_t>(parsed.error->length);
  }
  source.values.wrong(place, parsed.error->message);
  return step;
}

}  // namespace s7200::tools
