// fault: a fault of the line from now on, or none any more.
#include "serial_sim/faults/fault.hpp"

#include "interpreter/base/text/text.hpp"
#include "tools/plan/reading/system_reading.hpp"
#include "tools/scenario/run.hpp"
#include "tools/scenario/steps/steps.hpp"
#include "tools/scenario/transcripts/transcript_writer.hpp"

namespace s7200::tools {
namespace {

struct FaultStep final : StepAction {
  std::optional<serial::Fault> fault{};
  std::optional<EventPlan> event{};  ///< the same in a system
  std::string station{};             ///< as it was written

  Needs needs() const override { return Needs::Around; }

  void act(Run& run) const override {
    if (event)
      run.carry_out(*event);
    else
      run.plant()->act(InjectFault{.fault = fault});
  }

  bool write(TranscriptWriter& writer) const override {
    writer.step("fault: " + (fault ? serial::to_text(*fault) : "none"));
    if (!station.empty()) writer.beside("station: " + station);
    return true;
  }
};

std::optional<serial::Fault> parse_fault_of(const StepSource& source, const std::string& written) {
  serial::ParsedFault parsed = serial::parse_fault(written);
  if (parsed.ok()) return std::move(parsed.fault);
  const serial::FaultError& error = *parsed.error;
  source.values.wrong(part_of(source.is, written, error.column - 1, error.length), error.message);
  return {};
}

/// The event that does it; nothing after a complaint.
std::optional<EventPlan> event_of(const StepSource& source, const std::optional<serial::Fault>& fault) {
  const SystemPlan& plan = *source.scenario.plan;
  EventPlan event{.what = fault ? EventPlan::What::Fault : EventPlan::What::ClearFaults,
                  .line = source.step.spot ? source.step.spot->line : source.step.line.value()};
  if (!fault) return event;
  const auto of = read_fault(source.is, source.beside("station"), plan.lines[event.line], plan, source.values);
  if (!of) return {};
  event.fault = *of;
  return event;
}

}  // namespace

std::shared_ptr<const StepAction> read_fault(const StepSource& source) {
  auto step = std::make_shared<FaultStep>();
  const auto written = source.values.text(source.is);
  const bool none = !written || stl::lower_case(*written) == "none";
  if (!none) step->fault = parse_fault_of(source, *written);
  if (!none && !step->fault) return step;
  if (const YamlNode* const station = source.beside("station")) {
    if (none)
      source.values.wrong(*station, "'fault: none' ends all faults of the line, whosever they are", "leave 'station' out");
    else if (!source.scenario.plan)
      source.values.wrong(*station, "'station' says whose fault it is in a system", "name the file of one with 'system:'");
    if (none || !source.scenario.plan) return step;
    step->station = source.values.text(*station).value_or("");
  }
  if (source.scenario.plan) step->event = event_of(source, step->fault);
  return step;
}

}  // namespace s7200::tools
