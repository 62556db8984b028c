#include "tools/calibration/forms.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "interpreter/program/load.hpp"
#include "serial_sim/system/simulation.hpp"
#include "tools/calibration/measure_program.hpp"
#include "tools/calibration/measurement.hpp"

namespace s7200::tools {
namespace {

// Times that tell from how long an instruction took what it consisted of. A scan with all loops stays below the watchdog's
// 300 ms with them.
constexpr Time kBase = 100'000, kPerUnit = 1'000, kPointer = 100;

TimeTable telling_times(const TimeTable& times) {
  return times.with([](TimeRow& row) {
    const bool of_pointer = row.mnemonics.front() == name_of(SystemTime::IndirectOperand);
    row.base = row.base == 0 ? 0 : of_pointer ? kPointer : kBase;
    row.per_unit = row.per_unit == 0 ? 0 : kPerUnit;
  });
}

/// How often each form was executed.
using Counts = std::map<std::size_t, double>;

/// Takes an executed instruction apart, once the counting is on.
class FormCounter final : public TraceSink {
 public:
  FormCounter(const Program& program, const TimeTable& times, std::vector<Form>& forms)
      : program_(program), times_(times), forms_(forms) {}

  bool wants_instructions() const override { return true; }
  void instruction(const InstructionRecord& record) override {
    const Op& op = program_.ops[record.op];
    if (!record.powered) return count({std::string(name_of(SystemTime::NoPowerFlow)), row_of(SystemTime::NoPowerFlow)}, 1);
    const std::string mnemonic(op.instruction->mnemonic);
    const TimeRow* row = times_.find(mnemonic, first_area(record.op));
    const Time took = record.end - record.at;
    count({mnemonic, row}, took >= kBase ? 1 : 0);
    if (took < kBase) return;  // a label
    count({mnemonic, row, true}, static_cast<double>(took % kBase / kPerUnit));
    count({std::string(name_of(SystemTime::IndirectOperand)), row_of(SystemTime::IndirectOperand)},
          static_cast<double>(took % kPerUnit / kPointer));
  }

  Counts take() { return std::exchange(counts_, {}); }

 private:
  const TimeRow* row_of(SystemTime what) const { return times_.find(name_of(what), {}); }

  std::optional<Area> first_area(std::uint32_t op) const {
    const stl::Statement& statement = program_.statement(op);
    if (statement.operands.empty()) return {};
    const auto* address = std::get_if<stl::Address>(&statement.operands.front().value);
    return address ? area_named(address->area) : std::nullopt;
  }

  void count(const Form& form, double times) {
    if (times == 0) return;
    auto known = std::ranges::find(forms_, form);
    if (known == forms_.end()) known = forms_.insert(forms_.end(), form);
    counts_[static_cast<std::size_t>(known - forms_.begin())] += times;
  }

  const Program& program_;
  const TimeTable& times_;
  std::vector<Form>& forms_;
  Counts counts_;
};

void poke_word(Cpu& cpu, std::uint32_t address, std::uint32_t value) {
  const std::array<std::uint8_t, 2> bytes{static_cast<std::uint8_t>(value >> 8), static_cast<std::uint8_t>(value)};
  cpu.poke(image::kV + address, bytes);
}

/// The instructions of the repetitions alone: those between the beginning of the outer loop and its end.
class Window final : public TraceSink {
 public:
  Window(const Program& program, FormCounter& counter) : program_(program), counter_(counter) {}
  bool wants_instructions() const override { return true; }
  void instruction(const InstructionRecord& record) override {
    const std::string_view mnemonic = program_.ops[record.op].instruction->mnemonic;
    if (mnemonic == "WDR") inside_ = true;
    if (mnemonic == "XMT") inside_ = false;
    if (inside_) counter_.instruction(record);
  }

 private:
  const Program& program_;
  FormCounter& counter_;
  bool inside_ = false;
};

}  // namespace

std::shared_ptr<const Program> measuring_program(const CpuModel& model, const TimeTable& times) {
  return check_text(kMeasureTimes, "measure_times.stl", model, times).program;
}

Loops find_loops(const CpuModel& model, const TimeTable& times) {
  Loops found;
  const auto program = measuring_program(model, telling_times(times));
  if (!program) return found;
  FormCounter counter(*program, times, found.forms);
  Window window(*program, counter);
  const auto run = [&](std::size_t loop, std::uint32_t repetitions) {
    serial::Simulation simulation(program);
    Cpu& cpu = simulation.cpu();
    simulation.power_up();
    cpu.pause_at_scan_end(true);
    simulation.run_until(10 * kSecond);
    poke_word(cpu, Command::kLoop, static_cast<std::uint32_t>(0x6D00 | loop));
    poke_word(cpu, Command::kOuter, 1);
    poke_word(cpu, Command::kInner, repetitions);
    const std::array<std::uint8_t, 1> request{1};  // M31.0
    cpu.poke(image::kM + 31, request);
    cpu.set_sink(&window);
    simulation.run_until(simulation.time() + 100 * kSecond);
    cpu.set_sink(nullptr);
    return counter.take();
  };
  std::vector<Counts> more;
  for (std::size_t loop = 0; loop < measured_loops(*program); ++loop) {
    Counts twice = run(loop, 2);
    for (const auto& [form, times_once] : run(loop, 1)) twice[form] -= times_once;
    more.push_back(std::move(twice));
  }
  for (const Counts& counts : more) {
    Repetition repetition(found.forms.size(), 0);
    for (const auto& [form, times_more] : counts) repetition[form] = times_more;
    found.loops.push_back(std::move(repetition));
  }
  return found;
}

}  // namespace s7200::tools
