#include "tests/reference_model/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace s7200::reference {

const std::array<AreaPair, 17> kAreaPairs{{
    {&Memory::V, image::kV, "VB"},
    {&Memory::L, image::kL, "LB"},
    {&Memory::I, image::kI, "IB"},
    {&Memory::Q, image::kQ, "QB"},
    {&Memory::M, image::kM, "MB"},
    {&Memory::SM, image::kSM, "SMB"},
    {&Memory::S, image::kS, "SB"},
    {&Memory::AI, image::kAI, "AI byte "},
    {&Memory::AQ, image::kAQ, "AQ byte "},
    {&Memory::T, image::kT, "T current values, byte "},
    {&Memory::C, image::kC, "C current values, byte "},
    {&Memory::HC, image::kHC, "HC byte "},
    {&Memory::AC, image::kAC, "AC byte "},
    {&Memory::timer_bits, image::kTBits, "timer bits, byte "},
    {&Memory::counter_bits, image::kCBits, "counter bits, byte "},
    {&Memory::input_points, image::kInputs, "input points, byte "},
    {&Memory::output_points, image::kOutputs, "output points, byte "},
}};

namespace {

/// Collects lines `what: reference x, interpreter y`.
class Differences {
 public:
  template <class A, class B>
  void check(std::string_view what, const A& reference, const B& interpreter) {
    const auto a = static_cast<std::int64_t>(reference), b = static_cast<std::int64_t>(interpreter);
    if (a != b) text_ += fmt::format("  {}: reference {}, interpreter {}\n", what, a, b);
  }

  void check(const AreaPair& pair, const Bytes& reference, const std::uint8_t* interpreter) {
    if (std::equal(reference.begin(), reference.end(), interpreter)) return;
    for (std::size_t i = 0; i < reference.size(); ++i)
      if (reference[i] != interpreter[i])
        text_ +=
            fmt::format("  {}{}: reference 16#{:02X}, interpreter 16#{:02X}\n", pair.name, i, reference[i], interpreter[i]);
  }

  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

unsigned bits_of(const Stack& stack) {
  unsigned bits = 0;
  for (std::size_t i = 0; i < stack.size(); ++i) bits |= static_cast<unsigned>(stack[i]) << i;
  return bits;
}

void compare_calls(const Machine& machine, const State& state, Differences& differences) {
  differences.check("calls", machine.calls.size(), state.call_depth);
  for (std::size_t i = 0; i < std::min<std::size_t>(machine.calls.size(), state.call_depth); ++i) {
    differences.check("return position", machine.calls[i].return_to, state.calls[i].return_to);
    differences.check("saved stack", bits_of(machine.calls[i].stack), state.calls[i].stack.bits());
  }
}

void compare_errors(const Machine& machine, const State& state, Differences& differences) {
  differences.check("errors", machine.error_count, state.error_count);
  for (std::size_t i = 0; i < state.errors.size(); ++i) {
    const RuntimeError& theirs = state.errors[i];
    const Machine::Error ours = i < machine.errors.size() ? machine.errors[i] : Machine::Error{};
    differences.check("error code", ours.code, theirs.code);
    differences.check("error position", ours.position, theirs.op);
    differences.check("error count", ours.count, theirs.count);
    differences.check("time of error", ours.first, theirs.first);
  }
  differences.check("fatal error", machine.fatal_code, state.fatal_code);
  if (machine.fatal_code != 0)
    differences.check("position of the fatal error",
                      machine.fatal_position ? static_cast<std::uint32_t>(*machine.fatal_position) : kNoRoutine,
                      state.fatal_op);
}

}  // namespace

void copy_to(Cpu& cpu, const Memory& memory) {
  for (const AreaPair& pair : kAreaPairs) cpu.poke(pair.base, memory.*pair.bytes);
}

std::string compare(const Machine& machine, const Cpu& cpu) {
  const State& state = cpu.state();
  Differences differences;
  differences.check("time", machine.time, state.time);
  differences.check("RUN", machine.running, state.mode == Mode::Run);
  compare_errors(machine, state, differences);
  if (machine.running) {
    differences.check("in the program", machine.in_program, state.phase == Phase::Program);
    if (machine.in_program) {
      differences.check("position", machine.position, state.pc);
      differences.check("logic stack", bits_of(machine.stack), state.stack.bits());
      compare_calls(machine, state, differences);
    }
    differences.check("interrupts enabled", machine.interrupts_enabled, state.interrupts_enabled);
  }
  for (const AreaPair& pair : kAreaPairs) differences.check(pair, machine.memory.*pair.bytes, &state.image[pair.base]);
  return differences.text();
}

}  // namespace s7200::reference
