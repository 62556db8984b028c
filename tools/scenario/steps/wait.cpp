#include "tools/scenario/steps/wait.hpp"

#include "tools/scenario/run.hpp"
#include "tools/scenario/transcripts/transcript_writer.hpp"

namespace s7200::tools {
namespace {

std::optional<WaitStep> parse_wait(const std::string& text) {
  WaitStep step;
  if (constexpr std::string_view kUntil = "until "; text.starts_with(kUntil)) {
    const auto end = parse_span(text.substr(kUntil.size()));
    if (!end || end->millicharacters != 0) return {};
    step.until = end->fixed;
    return step;
  }
  if (const auto span = parse_span(text)) {
    step.time = *span;
    return step;
  }
  const std::size_t unit = text.find(" scan");
  const auto count = unit == std::string::npos ? std::nullopt : parse_number(text.substr(0, unit));
  if (!count || *count < 1 || *count > 100'000) return {};
  if (text.substr(unit) != " scans" && text.substr(unit) != " scan") return {};
  step.scans = static_cast<std::uint64_t>(*count);
  return step;
}

}  // namespace

void WaitStep::wait_until(Run& run) const {
  const Time end = run.begin() + *until, now = run.slave().now();
  if (end >= now) return run.slave().wait(end - now);
  if (end + run.allowed_delay() >= now) return;
  run.add({.what = "wait",
           .expected = fmt::format("to go on at {}", format_duration(*until, 6)),
           .found = fmt::format("it is {} already", format_duration(now - run.begin(), 6))});
}

void WaitStep::act(Run& run) const {
  if (until) return wait_until(run);
  if (scans == 0) return run.slave().wait(time.in(run.format()));
  if (!run.plant()->has_power())
    return run.add({.what = "scans",
                    .expected = fmt::format("{} scans", scans),
                    .found = "the PLC has no power: nothing was waited for",
                    .of_run = true});
  if (run.plant()->wait_scans(scans)) return;
  const bool stopped = run.plant()->cpu().state().mode == Mode::Stop;
  run.add({.what = "scans",
           .expected = fmt::format("{} scans", scans),
           .found = stopped ? "the CPU is in STOP" : "they did not come within a minute"});
}

bool WaitStep::write(TranscriptWriter& writer) const {
  if (until)
    writer.step("wait: until " + exact(*until));
  else
    writer.step("wait: " + (scans ? fmt::format("{} scans", scans) : exact(time)));
  return true;
}

std::shared_ptr<const StepAction> read_wait(const StepSource& source) {
  const auto step =
      source.values.value(&source.is, ValueReader::kDuration, "20ms, 3.5 characters, 2 scans, until 1.5s", parse_wait);
  const bool is_said = source.program() || !source.scenario.on.empty();
  if (step && step->scans > 0 && source.scenario.plan && !is_said)
    source.values.wrong(source.is, "scans of which PLC?", "put on: NAME beside it");
  return std::make_shared<WaitStep>(step.value_or(WaitStep{}));
}

}  // namespace s7200::tools
