#include "tools/scenario/steps/wait_until.hpp"

#include <algorithm>

#include "interpreter/cpu/units/forcing.hpp"
#include "tools/scenario/run.hpp"
#include "tools/scenario/transcripts/transcript_writer.hpp"
#include "tools/views/state/memory.hpp"

namespace s7200::tools {
namespace {

/// A CPU in STOP is not waited for.
std::string when_given_up(bool early, Time waited) {
  if (!early) return fmt::format(" after {}", format_duration(waited));
  return waited == 0 ? " with the CPU in STOP"
                     : fmt::format(" when the CPU went to STOP, after {}", format_duration(waited));
}

}  // namespace

/// A program that does not get there cannot be asked what comes after it.
void WaitUntilStep::act(Run& run) const {
  run.count_check();
  Plant& plant = *run.plant();
  const auto in_memory = [&](const MemoryExpected& e) { return forcing::seen_outside(plant.cpu().state(), e.range); };
  const auto fits = [&](const MemoryExpected& e) { return e.fits(in_memory(e)); };
  const Time most = timeout.value_or(run.scenario().line.timeout), begin = plant.simulation().time();
  if (plant.wait_until([&] { return std::all_of(expected.begin(), expected.end(), fits); }, most)) return;
  const bool stopped = plant.cpu().state().mode == Mode::Stop;
  const bool early = stopped && plant.simulation().time() - begin < most;
  const Time waited = early ? plant.simulation().time() - begin : most;  // the last instruction may end later
  for (const MemoryExpected& e : expected) {
    if (fits(e)) continue;
    Finding finding = memory_finding(plant.cpu().program(), e, in_memory(e));
    finding.what = plant.of_plc(finding.what) + when_given_up(early, waited);
    if (stopped) add_remark(finding.found, "the CPU is in STOP" + plant.why_stopped());
    finding.of_run = true;
    finding.waited = waited;
    run.add(std::move(finding));
  }
}

/// A replay waits as long for what does not come.
bool WaitUntilStep::write(TranscriptWriter& writer) const {
  if (const auto waited = writer.waited_in_vain()) {
    writer.step("wait: " + exact(*waited));
    return true;
  }
  writer.step("wait_until: " + to_text(expected));
  if (timeout) writer.beside("timeout: " + exact(*timeout));
  return true;
}

std::shared_ptr<const StepAction> read_wait_until(const StepSource& source) {
  auto step = std::make_shared<WaitUntilStep>();
  step->expected = read_memory_expected(source.values, source.is, source.addresses());
  step->timeout = source.values.time(source.beside("timeout"));
  return step;
}

}  // namespace s7200::tools
