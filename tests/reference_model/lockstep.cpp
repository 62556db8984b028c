#include "tests/reference_model/lockstep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/cpu/cpu.hpp"
#include "interpreter/stl/parser.hpp"
#include "interpreter/stl/printer.hpp"
#include "tests/reference_model/comparison.hpp"
#include "tests/reference_model/generator.hpp"
#include "tests/reference_model/machine.hpp"
#include "tests/reference_model/silent_port.hpp"

namespace s7200::reference {
namespace {

constexpr std::uint64_t kInstructionsOfProgram = 2000;
constexpr std::uint64_t kInstructionsOfMemory = 150;
constexpr int kPowerUps = 6;

/// So far the CPU runs at once where nobody looks, which goes through several links of its fast loop.
constexpr std::size_t kMostAtOnce = 12;

/// Makes the CPU use its observed loop.
class Observer : public TraceSink {
 public:
  bool wants_instructions() const override { return true; }
};

/// The same program on a CPU whose pointers reach no special and no analog memory, as those of the reference model.
std::shared_ptr<const Program> without_pointers_to_special_memory(const Program& program) {
  const auto same = std::make_shared<Program>(program);
  for (const Area area : {Area::SM, Area::AI, Area::AQ}) same->reach[*info(area).pointer_code] = {};
  return same;
}

/// The part of a generated text that the checker accepts: lines that it refuses are left out.
std::shared_ptr<const Program> accepted(std::string& text, const CpuModel& model, const TimeTable& times) {
  for (int attempt = 0; attempt < 20; ++attempt) {
    const CheckResult result = check_text(text, "random", model, times);
    if (result.program) return without_pointers_to_special_memory(*result.program);
    std::vector<bool> refused(result.source.text.size() + 1);
    for (const auto& diagnostic : result.diagnostics)
      if (diagnostic.severity == stl::Severity::Error) refused.at(diagnostic.position.line) = true;
    text.clear();
    for (std::size_t i = 0; i < result.source.text.size(); ++i)
      if (!refused[i + 1]) text += result.source.text[i] + "\n";
  }
  return nullptr;
}

/// The rare state that the instruction at the reference model's position is about to meet; nothing if the state is common.
std::optional<std::string> rare_state(Machine& m) {
  const stl::Statement& statement = m.statement();
  if (statement.operands.size() != 2 || std::holds_alternative<stl::Indirect>(statement.operands[1].value)) return {};
  const std::string& mnemonic = statement.mnemonic;
  const bool word = mnemonic == "RLW" || mnemonic == "RRW";
  if (word || mnemonic == "RLD" || mnemonic == "RRD") {
    const std::uint32_t count = m.in(1, 1);
    return count > 0 && count % (word ? 16 : 32) == 0 ? std::optional("rotate by whole turns") : std::nullopt;
  }
  if (mnemonic != "R" || m.address(0).area != "T") return {};
  const std::size_t first = m.address(0).number, end = std::min<std::size_t>(first + m.in(1, 1), m.timers.size());
  for (std::size_t timer = first; timer < end; ++timer)
    if (m.timers[timer].enabled)
      return is_100_ms(timer) ? "R of a 100 ms timer that counts" : "R of a fast timer that counts";
  return {};
}

bool adds(const std::string& mnemonic) {
  return mnemonic == "+I" || mnemonic == "-I" || mnemonic == "+D" || mnemonic == "-D";
}

/// One program, run on both.
class Pair {
 public:
  Pair(std::shared_ptr<const Program> program, Generator& generator, bool observed)
      : program_(std::move(program)),
        generator_(generator),
        observed_(observed),
        cpu_(program_, queue_, EventOwner{}, {&port_, &port_}),
        machine_(program_->source, cpu_kind(std::string(program_->model->name))) {
    if (observed) cpu_.set_sink(&observer_);
    executed_.resize(machine_.statements().size());
  }

  /// Runs both from power-up until STOP, a difference, or this many instructions. Returns the number executed.
  std::uint64_t run(std::uint64_t instructions) {
    queue_ = {};
    cpu_.power_up();
    machine_.power_up();
    std::uint64_t done = 0, until_fill = 0;
    while (done < instructions && machine_.running && !difference_) {
      if (until_fill == 0) {
        fill();
        until_fill = kInstructionsOfMemory;
      }
      const std::size_t executed = step();
      done += executed;
      until_fill -= std::min<std::uint64_t>(until_fill, executed);
    }
    return done;
  }

  const std::optional<std::string>& difference() const { return difference_; }

  void count_into(LockstepResult& result) const {
    for (std::size_t i = 0; i < executed_.size(); ++i) result.executed[machine_.statements()[i].mnemonic] += executed_[i];
    for (const auto& [what, times] : met_) result.met[what] += times;
  }

 private:
  void fill() {
    generator_.fill(machine_.memory);
    copy_to(cpu_, machine_.memory);
  }

  /// Runs both until the clock has moved on, once or several times, and compares. Returns how many instructions that took.
  std::size_t step() {
    steps_.clear();
    std::size_t executed = 0;
    for (std::size_t moves = observed_ ? 1 : 1 + generator_.below(kMostAtOnce); moves > 0 && machine_.running; --moves)
      executed += step_machine();
    while (cpu_.time() < machine_.time) {
      cpu_.run(machine_.time);
      while (queue_.next() <= cpu_.time()) cpu_.handle(queue_.pop());
    }
    if (machine_.running) machine_.count_milliseconds();  // in STOP timers do not count
    if (const std::string found = compare(machine_, cpu_); !found.empty()) difference_ = describe(found);
    return executed;
  }

  /// Until its clock has moved on: labels take no time.
  std::size_t step_machine() {
    const std::int64_t before = machine_.time;
    std::size_t executed = 0;
    do {
      const bool instruction = machine_.in_program && machine_.running;
      const std::size_t position = machine_.position;
      const std::uint64_t errors = machine_.error_count;
      const bool powered = machine_.has_power();
      std::optional<std::string> rare;
      if (instruction) {
        ++executed;
        steps_.push_back(position);
        if (powered) rare = rare_state(machine_);
      }
      machine_.step();
      if (instruction && powered && machine_.error_count == errors) {
        ++executed_[position];
        if (adds(machine_.statements()[position].mnemonic) && read(machine_.flag(1))) rare = "overflow of a sum";
        if (rare) ++met_[*rare];
      }
      if (instruction && machine_.fatal_code == 0x12) ++met_["compare with a value that is not a number"];
    } while (machine_.time == before);
    return executed;
  }

  std::string describe(const std::string& found) const {
    std::string text;
    for (const std::size_t position : steps_)
      text += fmt::format("after {}: {}\n", position, stl::to_text(machine_.statements()[position]));
    if (steps_.empty()) text += "after the system's part of the scan\n";
    return text + found;
  }

  std::shared_ptr<const Program> program_;
  Generator& generator_;
  bool observed_;
  EventQueue queue_;
  SilentPort port_;
  Observer observer_;
  Cpu cpu_;
  Machine machine_;
  std::vector<std::size_t> steps_;       // positions of the statements just executed
  std::vector<std::uint64_t> executed_;  // how often, for each statement
  std::map<std::string, std::uint64_t> met_;
  std::optional<std::string> difference_;
};

std::string listing(const Program& program) {
  std::string text;
  for (std::size_t i = 0; i < program.statements.size(); ++i)
    text += fmt::format("{:4}  {}\n", i, stl::to_text(program.statements[i]));
  return text;
}

}  // namespace

LockstepResult run_lockstep(std::uint64_t seed, std::uint64_t instructions, const std::string& cpu) {
  LockstepResult result;
  const CpuModel& model = *find_cpu(cpu);
  const TimeTable times = default_times(model);
  for (; result.instructions < instructions && !result.difference; ++seed, ++result.programs) {
    Generator generator(seed, model);
    std::string text = generator.program();
    const auto program = accepted(text, model, times);
    if (!program) {
      result.difference = fmt::format("seed {}: the checker accepts no part of\n{}", seed, text);
      break;
    }
    Pair pair(program, generator, seed % 2 == 1);
    std::uint64_t done = 0;
    for (int i = 0; i < kPowerUps && done < kInstructionsOfProgram && !pair.difference(); ++i)
      done += pair.run(kInstructionsOfProgram - done);
    result.instructions += done;
    pair.count_into(result);
    if (pair.difference())
      result.difference = fmt::format("{}\nseed {}, program:\n{}", *pair.difference(), seed, listing(*program));
  }
  return result;
}

}  // namespace s7200::reference
