// memory: what must be in memory now.
#include <utility>

#include "interpreter/cpu/units/forcing.hpp"
#include "tools/scenario/reading/memory_values.hpp"
#include "tools/scenario/run.hpp"
#include "tools/scenario/steps/steps.hpp"
#include "tools/scenario/transcripts/transcript_writer.hpp"

namespace s7200::tools {
namespace {

struct MemoryStep final : StepAction {
  std::vector<MemoryExpected> expected{};

  Needs needs() const override { return Needs::ToLook; }

  void act(Run& run) const override {
    run.count_check();
    const Cpu& cpu = run.plant()->cpu();
    for (const MemoryExpected& e : expected) {
      const Bytes found = forcing::seen_outside(cpu.state(), e.range);
      if (e.fits(found)) continue;
      Finding finding = memory_finding(cpu.program(), e, found);
      finding.what = run.plant()->of_plc(finding.what);
      run.add(std::move(finding));
    }
  }

  bool write(TranscriptWriter& writer) const override {
    if (!writer.expects_memory()) return false;
    writer.step("memory: " + to_text(expected));
    return true;
  }
};

}  // namespace

std::shared_ptr<const StepAction> read_memory(const StepSource& source) {
  auto step = std::make_shared<MemoryStep>();
  step->expected = read_memory_expected(source.values, source.is, source.addresses());
  return step;
}

}  // namespace s7200::tools
