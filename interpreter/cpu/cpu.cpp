#include "interpreter/cpu/cpu.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "interpreter/cpu/execute.hpp"
#include "interpreter/cpu/interrupts.hpp"
#include "interpreter/cpu/ports/freeport.hpp"
#include "interpreter/cpu/scan.hpp"
#include "interpreter/cpu/units.hpp"
#include "interpreter/cpu/units/clock.hpp"
#include "interpreter/cpu/units/forcing.hpp"
#include "interpreter/cpu/units/points.hpp"
#include "interpreter/cpu/units/power.hpp"

namespace s7200 {
namespace {

/// Lets a program be learnt that somebody watches: what it does then is undone, and what can be learnt works on the state
/// alone. After that the program is executed.
void learn_unseen(Core& core, SteadyScans& scans) {
  const auto before = std::make_unique<State>(core.s);
  const Loop loop = core.loop;
  TraceSink* const sink = core.sink();
  core.set_sink(nullptr);
  scans.learn(core);
  core.set_sink(sink);
  core.loop = loop;
  core.s = *before;
}

}  // namespace

Cpu::Cpu(std::shared_ptr<const Program> program, EventQueue& queue, EventOwner owner, const Ports& ports)
    : core_(std::move(program), queue, owner, ports) {}

Core& Cpu::from_outside() {
  core_.touched = true;
  return core_;
}

void Cpu::power_up(bool run, const RetentiveMemory* memory, Time at) { power::up(from_outside(), run, memory, at); }
RetentiveMemory Cpu::retentive_memory() const { return power::retentive_memory(core_); }

void Cpu::run(Time limit, Time work) {
  const State& s = core_.s;
  core_.loop.paused = false;
  const Mode mode = s.mode;
  Time end = s.time + std::min(work, limit - s.time);
  while (s.time < end && !core_.loop.paused && s.mode == mode) {
    const Time event = core_.next_event();
    if (event <= s.time) return;
    if (s.watchdog <= s.time) {
      core_.fatal_error(FatalError::Watchdog);
      continue;
    }
    core_.loop.until = std::min({end, event, s.watchdog});
    if (interrupts::due(core_)) interrupts::take(core_);
    if (!s.in_interrupt) {
      if (const Time passed = steady_scans_.pass_over(core_, limit); passed != 0) {
        end = passed < limit - end ? end + passed : limit;
        continue;
      }
      core_.loop.until = std::min(core_.loop.until, steady_scans_.stop_at());
      if (s.phase != Phase::Program) scan::advance(core_);
      if (s.phase != Phase::Program) continue;
    }
    const bool learns = steady_scans_.learns(s);
    const bool observed = core_.sink() && core_.sink()->wants_instructions();
    if (learns) observed ? learn_unseen(core_, steady_scans_) : steady_scans_.learn(core_);
    if (observed)
      execute_observed(core_.sink()->watcher());
    else if (!learns)
      execute_plain();
  }
}

Time Cpu::look_ahead() {
  const bool acts = core_.s.in_interrupt || interrupts::due(core_);
  return acts ? core_.s.time : steady_scans_.look_ahead(core_);
}

/// The fast loop goes as far as whole chains go.
void Cpu::execute_plain() {
  State& s = core_.s;
  Loop& loop = core_.loop;
  const Op* const ops = core_.program().ops.data();
  if (const Op& op = ops[s.pc]; op.link && s.time < loop.until) op.link(core_, &op, loop.until - s.time, s.stack.bits(), 0);
  const Time no_power_flow = core_.program().no_power_flow;
  std::uint64_t executed = 0;
  while (s.time < loop.until) {
    execute_next(core_, ops, no_power_flow);
    ++executed;
  }
  s.instructions += executed;
}

void Cpu::execute_observed(TraceSink& sink) {
  switch (sink.watch()) {
    case Watch::Flow:
      return execute_watched<Watch::Flow>(sink);
    case Watch::Values:
      return execute_watched<Watch::Values>(sink);
    case Watch::Stops:
      return execute_watched<Watch::Stops>(sink);
  }
}

template <Watch watch>
void Cpu::execute_watched(TraceSink& sink) {
  State& s = core_.s;
  Loop& loop = core_.loop;
  const Op* const ops = core_.program().ops.data();
  const Time no_power_flow = core_.program().no_power_flow;
  while (s.time < loop.until) {
    if (watch == Watch::Stops && !sink.before(s.pc)) {
      loop.paused = true;
      return;
    }
    loop.op = s.pc;
    const Op& op = ops[loop.op];
    InstructionRecord record{.at = s.time, .op = loop.op};
    const bool values = watch != Watch::Flow || op.is_contact;
    if (values) look_at(op, op.inputs, record);
    ++s.instructions;
    record.powered = !(op.power_mask & ~s.stack.bits());
    if (record.powered) {
      s.time += op.cost;
      s.pc = loop.op + 1;
      op.body(core_, op);
    } else {
      s.time += no_power_flow;
      s.pc = op.skip_to;
      s.eno &= !op.sets_eno;
    }
    record.end = s.time;
    record.top = s.stack.top();
    if (values) look_at(op, op.outputs, record);
    sink.instruction(record);
  }
}

/// `operands` has a bit for each operand.
inline void Cpu::look_at(const Op& op, std::uint8_t operands, InstructionRecord& record) const {
  for (std::size_t i = 0; operands >> i != 0; ++i)
    if (operands >> i & 1) record.value[i] = peek(op, i);
}

Time Cpu::next_action() const {
  const State& s = core_.s;
  if (s.in_interrupt || s.phase == Phase::Program || interrupts::due(core_)) return s.time;
  return std::max(s.time, std::min(s.time + s.phase_left, s.watchdog));
}

void Cpu::handle(const Event& event) { units::handle(from_outside(), event.what, event.at); }

void Cpu::character_received(const ReceivedCharacter& character, std::uint8_t port) {
  freeport::character_received(from_outside(), port, character);
}
void Cpu::character_missed(const ReceivedCharacter& character, std::uint8_t port, bool powered) const {
  freeport::character_missed(core_, port, character, powered);
}
void Cpu::character_sent(Time at, std::uint8_t port) { freeport::character_sent(from_outside(), port, at); }

void Cpu::set_input(std::uint32_t byte, std::uint8_t value, Time at) { points::set_inputs(from_outside(), byte, value, at); }

void Cpu::set_clock(const ClockTime& to) { clock::set(from_outside(), to); }
ClockTime Cpu::clock() const { return clock::now(core_); }

void Cpu::poke(std::uint32_t at, std::span<const std::uint8_t> bytes) {
  std::copy(bytes.begin(), bytes.end(), from_outside().s.image.begin() + at);
  if (at >= image::kAI && at < image::kAQ)
    std::copy(bytes.begin(), bytes.end(), core_.s.analog_terminals.begin() + (at - image::kAI));
  forcing::apply(core_);
  if (core_.s.mode == Mode::Run) freeport::follow_control(core_);
}

bool Cpu::force(const MemoryRange& place, std::uint32_t value) { return forcing::force(from_outside(), place, value); }
bool Cpu::unforce(const MemoryRange& place) { return forcing::unforce(from_outside(), place); }

std::optional<std::uint32_t> Cpu::peek(const Op& op, std::size_t i) const {
  const OperandRule& rule = op.instruction->operand[i];
  if (rule.kind != OperandKind::Memory) return op[i].at;
  return peek(op[i], rule.width);
}

std::optional<std::uint32_t> Cpu::peek(const Operand& operand, Width width) const {
  const auto place = place_of(operand);
  if (!place) return {};
  return load_value(&core_.s.image[*place], width, operand.bit);
}

}  // namespace s7200
