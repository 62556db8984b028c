// What happens to a system in the field, as under `events` of its file: power_off, cut …
#include "tools/plan/reading/event_reader.hpp"
#include "tools/scenario/run.hpp"
#include "tools/scenario/steps/steps.hpp"
#include "tools/scenario/transcripts/transcript_writer.hpp"

namespace s7200::tools {
namespace {

struct EventOfSystemStep final : StepAction {
  EventPlan event{};
  std::string written{};              ///< `cut: bus`
  std::vector<std::string> beside{};  ///< `after: slave1`

  Needs needs() const override { return Needs::Around; }

  void act(Run& run) const override { run.carry_out(event); }

  bool write(TranscriptWriter& writer) const override {
    writer.step(written);
    for (const std::string& each : beside) writer.beside(each);
    return true;
  }
};

}  // namespace

std::shared_ptr<const StepAction> read_event_of_system(const StepSource& source) {
  auto step = std::make_shared<EventOfSystemStep>();
  if (!source.scenario.plan) {
    source.values.wrong(source.node, "only a system has several PLCs and lines",
                        "name its file with 'system:', not 'program:'");
    return step;
  }
  const auto event = read_event(source.node, *source.scenario.plan, source.values);
  if (!event) return step;
  step->event = *event;
  const auto line_of = [&](std::string_view key) {
    return fmt::format("{}: {}", key, source.values.optional_text(source.node, key).value_or(""));
  };
  const EventWord& word = word_of(event->what);
  step->written = line_of(word.word);
  for (const std::string_view key : word.beside)
    if (source.beside(key)) step->beside.push_back(line_of(key));
  return step;
}

}  // namespace s7200::tools
