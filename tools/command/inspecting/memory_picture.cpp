#include "tools/command/inspecting/memory_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "interpreter/program/loading/system_block.hpp"
#include "interpreter/program/operands/address.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/host/files/files.hpp"
#include "tools/rig/memory_json.hpp"
#include "tools/views/state/memory.hpp"

namespace s7200::tools {
namespace {

void set_bit(State& state, std::uint32_t at, std::uint8_t bit, bool on) {
  const auto mask = static_cast<std::uint8_t>(1u << bit);
  state.image[at] = static_cast<std::uint8_t>(on ? state.image[at] | mask : state.image[at] & ~mask);
}

void put(State& state, const Assignment& assignment) {
  const MemoryRange& place = assignment.place;
  if (place.width == Width::Bit) return set_bit(state, place.at, place.bit, assignment.value != 0);
  const std::uint32_t bytes = bytes_of(place.width);
  for (std::uint32_t i = 0; i < bytes; ++i)
    state.image[place.at + i] = static_cast<std::uint8_t>(assignment.value >> (8 * (bytes - 1 - i)));
}

/// CTD is on at 0, all others from their preset on; whether a TOF is on its value does not say, so it is taken for off.
void put_bit_of_timer_or_counter(State& state, const Cpu& cpu, const Op& op) {
  const Instruction& instruction = *op.instruction;
  const bool timer = instruction.operand[0].areas == set_of(Area::T);
  const std::uint32_t number = op[2].at, at = (timer ? image::kT : image::kC) + 2 * number;
  const auto value = static_cast<std::int16_t>(state.image[at] << 8 | state.image[at + 1]);
  const auto preset = static_cast<std::int16_t>(cpu.peek(op, 1).value_or(0));
  set_bit(state, (timer ? image::kTBits : image::kCBits) + number / 8, static_cast<std::uint8_t>(number % 8),
          instruction.mnemonic == "CTD" ? value == 0 : value >= preset);
}

/// Of all of them, or of those that `assigned` gives a value or a preset.
void put_bits_of_timers_and_counters(Cpu& cpu, const std::vector<Assignment>* assigned) {
  const auto state = std::make_unique<State>(cpu.state());
  for (const Op& op : cpu.program().ops) {
    const Instruction& instruction = *op.instruction;
    if (instruction.hidden != Hidden::Number || instruction.mnemonic == "TOF") continue;
    const bool timer = instruction.operand[0].areas == set_of(Area::T);
    const std::uint32_t value = (timer ? image::kT : image::kC) + 2 * op[2].at;
    const auto is_of_it = [&](const Assignment& each) {
      const std::uint32_t end = each.place.at + bytes_of(each.place.width);
      return (each.place.at < value + 2 && value < end) || (each.place.at < op[1].at + 2 && op[1].at < end);
    };
    if (!assigned || std::ranges::any_of(*assigned, is_of_it)) put_bit_of_timer_or_counter(*state, cpu, op);
  }
  cpu.restore(*state);
}

void put_picture(Cpu& cpu, const RetentiveMemory& memory, const std::vector<Assignment>& assigned) {
  const auto state = std::make_unique<State>(cpu.state());
  for (const RetentiveRange& range : retainable(*cpu.program().model))
    std::copy_n(memory.image.begin() + range.at(), range.bytes(), state->image.begin() + range.at());
  for (const Assignment& each : assigned) put(*state, each);
  cpu.restore(*state);  // presets may be in V memory
  put_bits_of_timers_and_counters(cpu, nullptr);
}

/// What a first scan makes of memory that was set, as programs that initialise themselves do, is no part of the picture.
void keep_assigned(Cpu& cpu, const std::vector<Assignment>& assigned) {
  const auto state = std::make_unique<State>(cpu.state());
  for (const Assignment& each : assigned) put(*state, each);
  cpu.restore(*state);
  put_bits_of_timers_and_counters(cpu, &assigned);
}

void run_first_scan(serial::Simulation& simulation) {
  const Cpu& cpu = simulation.cpu();
  const Time end = cpu.time() + kSecond;
  while (cpu.state().scans == 0 && cpu.state().mode == Mode::Run && cpu.time() < end)
    simulation.run_until(cpu.time() + 100 * kMicrosecond);
}

}  // namespace

std::unique_ptr<serial::Simulation> pictured(std::shared_ptr<const Program> program, const std::string& memory_file,
                                             const std::vector<std::string>& set) {
  std::vector<Assignment> assigned;
  for (const std::string& text : set) {
    const auto assignment = parse_assignment(text, *program);
    if (!assignment) return print_error(fmt::format("--set: {}", assignment.why())), nullptr;
    assigned.push_back(*assignment);
  }
  auto simulation = std::make_unique<serial::Simulation>(std::move(program));
  simulation->power_up();
  if (memory_file.empty()) {
    for (const Assignment& each : assigned) assign(simulation->cpu(), each);
    run_first_scan(*simulation);
    keep_assigned(simulation->cpu(), assigned);
    return simulation;
  }
  const auto memory = read_file(memory_file).and_then([&](const std::string& text) {
    return memory_from_json(text, *simulation->cpu().program().model);
  });
  if (!memory) return print_error(fmt::format("--memory: cannot use {}: {}", memory_file, memory.why())), nullptr;
  put_picture(simulation->cpu(), *memory, assigned);
  print_note(fmt::format("{} has V, M, T and C memory; inputs and all else count as 0 unless --set says what they have",
                         memory_file));
  return simulation;
}

}  // namespace s7200::tools
