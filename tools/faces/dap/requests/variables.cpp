#include "tools/faces/dap/requests/variables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "interpreter/base/bytes.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/cpu/units/forcing.hpp"
#include "interpreter/model/errors.hpp"
#include "interpreter/model/ports.hpp"
#include "interpreter/model/special_bits.hpp"
#include "interpreter/program/checking/special_memory_use.hpp"
#include "interpreter/stl/printer.hpp"
#include "interpreter/trace/text/text_trace.hpp"
#include "tools/faces/dap/addresses.hpp"
#include "tools/session/observers/call_stack.hpp"
#include "tools/session/words/element_text.hpp"
#include "tools/views/report.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools::dap {
namespace {

// A container: what kind it is, and which of them.
enum Kind : Container { kLogicStack = 1, kAccumulators, kArea, kPort, kRuntime, kBits, kBlock };
constexpr unsigned kKindShift = 20;
constexpr Container kWhich = (1u << kKindShift) - 1;

constexpr Container container(Kind kind, Container which) { return kind << kKindShift | which; }

constexpr std::uint32_t kBlockSize = 256;  // bytes of V memory

constexpr Area kShown[] = {Area::I, Area::Q, Area::M,  Area::V,  Area::SM, Area::S,
                           Area::T, Area::C, Area::HC, Area::AI, Area::AQ, Area::L};

std::optional<MemoryRange> range_of(const std::string& text, const Program& program) {
  return parse_range(text, program).if_any();
}

std::string_view type_of(const MemoryRange& range) {
  if (range.real) return "REAL";
  constexpr std::string_view kNames[] = {"BOOL", "BYTE", "WORD", "DWORD"};
  return kNames[static_cast<std::size_t>(range.width)];
}

std::vector<Variable> logic_stack(const State& state, Container open) {
  const auto routines = open_routines(state);
  const LogicStack stack = open < routines.size() ? routines[open].stack : state.stack;
  std::vector<Variable> levels;
  for (int level = 0; level < LogicStack::kLevels; ++level)
    levels.push_back({.name = fmt::format("S{}", level),
                      .value = stack.level(level) ? "1" : "0",
                      .type = "BOOL",
                      .memory = level_reference(open, static_cast<std::uint32_t>(level)),
                      .settable = open == 0});
  return levels;
}

/// Of an interrupted routine they are those that it will find again, and cannot be set.
std::vector<Variable> accumulators(const Cpu& cpu, Container open) {
  const auto routines = open_routines(cpu.state());
  const bool saved = open < routines.size() && routines[open].interrupted;
  std::vector<Variable> all;
  for (std::uint32_t i = 0; i < cpu.program().model->size_of(Area::AC); ++i) {
    const std::string name = fmt::format("AC{}", i);
    const auto range = range_of(name, cpu.program());
    Variable variable = variable_of(cpu, *range, name);
    if (saved) {
      const auto bytes = std::span(routines[open].accumulators).subspan(std::size_t{4} * i, 4);
      variable = {.name = name, .value = value_text(cpu.program(), *range, bytes), .type = "DWORD"};
    }
    all.push_back(std::move(variable));
  }
  return all;
}

std::string_view meaning_of_special(std::uint32_t byte) {
  for (const SpecialMemory& row : special_memory())
    if (byte >= row.first && byte <= row.last) return row.meaning;
  return {};
}

Variable byte_of(const Cpu& cpu, Area area, std::uint32_t number) {
  const std::string name = fmt::format("{}B{}", info(area).name, number);
  const auto range = range_of(name, cpu.program());
  Variable byte = variable_of(cpu, *range, area == Area::SM ? fmt::format("{} {}", name, meaning_of_special(number)) : name);
  if (info(area).bits != kNoBits) byte.parts = container(kBits, range->at);
  return byte;
}

std::vector<Variable> bytes_of(const Cpu& cpu, Area area) {
  const CpuModel& model = *cpu.program().model;
  std::vector<Variable> bytes;
  for (std::uint32_t i = 0; i < model.size_of(area); ++i) {
    if (area != Area::SM || is_modelled_special_memory(model, i)) bytes.push_back(byte_of(cpu, area, i));
  }
  return bytes;
}

std::vector<Variable> elements_of(const Cpu& cpu, Area area) {
  std::vector<Variable> elements;
  const bool words = area == Area::AI || area == Area::AQ;
  for (std::uint32_t i = 0; i < cpu.program().model->size_of(area); i += words ? 2 : 1) {
    const std::string name = fmt::format("{}{}{}", info(area).name, words ? "W" : "", i);
    if (const auto range = range_of(name, cpu.program())) {
      elements.push_back(variable_of(cpu, *range, name));
      if (!words) elements.back().value += ", " + element_text(cpu, area, i);
    }
  }
  return elements;
}

/// What the program names, and all of it in blocks.
std::vector<Variable> v_memory(const Cpu& cpu) {
  std::vector<Variable> variables;
  for (const std::string& name : addresses_in(cpu.program()))
    if (const auto range = range_of(name, cpu.program()); range && range->area == Area::V)
      variables.push_back(variable_of(cpu, *range, name));
  const std::uint32_t size = cpu.program().model->size_of(Area::V);
  for (std::uint32_t first = 0; first < size; first += kBlockSize)
    variables.push_back({.name = fmt::format("VB{}…VB{}", first, std::min(size, first + kBlockSize) - 1),
                         .memory = fmt::format("VB{}", first),
                         .parts = container(kBlock, first)});
  return variables;
}

std::vector<Variable> area_variables(const Cpu& cpu, Area area) {
  if (area == Area::V) return v_memory(cpu);
  if (info(area).element != 0 || area == Area::AI || area == Area::AQ) return elements_of(cpu, area);
  return bytes_of(cpu, area);
}

std::vector<Variable> block_of_v(const Cpu& cpu, std::uint32_t first) {
  std::vector<Variable> bytes;
  const std::uint32_t end = std::min(cpu.program().model->size_of(Area::V), first + kBlockSize);
  for (std::uint32_t i = first; i < end; ++i) bytes.push_back(byte_of(cpu, Area::V, i));
  return bytes;
}

/// ` first scan`; nothing for one that has none.
std::string meaning_of_bit(std::uint32_t at, std::uint32_t bit) {
  const std::string meaning = special_meanings_text(at, static_cast<std::uint8_t>(1u << bit));
  return meaning.empty() ? "" : " " + meaning;
}

std::vector<Variable> bits_of_byte(const Cpu& cpu, std::uint32_t at) {
  std::vector<Variable> bits;
  for (const Area area : kShown) {
    const AreaInfo& of = info(area);
    if (of.element != 0 || at < of.base || at >= of.base + cpu.program().model->size_of(area)) continue;
    for (std::uint32_t bit = 0; bit < 8; ++bit) {
      const std::string name = fmt::format("{}{}.{}", of.name, at - of.base, bit);
      const std::string meaning = area == Area::SM ? meaning_of_bit(at, bit) : "";
      if (const auto range = range_of(name, cpu.program())) bits.push_back(variable_of(cpu, *range, name + meaning));
    }
  }
  return bits;
}

/// The lines of the view, each with its first word as a name.
std::vector<Variable> port_variables(const serial::Simulation& simulation) {
  std::vector<Variable> variables;
  for (const std::string& line : stl::split_lines(port_text(simulation))) {
    const std::size_t end = std::min(line.find(' '), line.size());
    variables.push_back({.name = line.substr(0, end), .value = std::string(stl::trim(std::string_view(line).substr(end)))});
  }
  return variables;
}

std::vector<Variable> attached_events(const State& state) {
  std::vector<Variable> events;
  for (std::uint8_t event = 0; event < kEvents; ++event)
    if (state.attached[event] != kNotAttached)
      events.push_back({.name = event_text(event), .value = fmt::format("INT {}", state.attached[event])});
  return events;
}

std::vector<Variable> waiting_interrupts(const State& state) {
  std::vector<Variable> waiting;
  for (const InterruptQueue& queue : state.queue)
    for (std::size_t i = 0; i < queue.count; ++i)
      waiting.push_back(
          {.name = "waiting " + waiting_text(queue.entry[i]), .value = "since " + moment_text(queue.entry[i].at)});
  return waiting;
}

std::vector<Variable> runtime(const Cpu& cpu, const History& history) {
  const State& state = cpu.state();
  std::vector<Variable> all{{.name = "time", .value = moment_text(state.time)},
                            {.name = "newest moment", .value = moment_text(history.newest().time)},
                            {.name = "oldest moment", .value = moment_text(history.usage().oldest.time)},
                            {.name = "mode", .value = state.mode == Mode::Run ? "RUN" : "STOP"},
                            {.name = "scan", .value = fmt::format("{}", state.scans + 1)},
                            {.name = "longest scan", .value = format_duration(state.longest_scan)},
                            {.name = "instructions", .value = fmt::format("{}", state.instructions)},
                            {.name = "interrupts", .value = state.interrupts_enabled ? "enabled" : "disabled"}};
  const auto add = [&all](const std::vector<Variable>& more) { all.insert(all.end(), more.begin(), more.end()); };
  if (state.in_interrupt)
    all.push_back({.name = "serving",
                   .value = fmt::format("{} since {}", event_text(state.serving_event), moment_text(state.serving_since))});
  add(waiting_interrupts(state));
  add(attached_events(state));
  std::size_t number = 0;
  for (const std::string& line : stl::split_lines(errors_text(cpu)))
    all.push_back({.name = fmt::format("error {}", ++number), .value = line});
  return all;
}

}  // namespace

std::vector<Scope> scopes_of(const serial::Simulation& simulation, std::uint32_t open) {
  const State& state = simulation.cpu().state();
  const CpuModel& model = *simulation.cpu().program().model;
  const std::uint32_t frame = std::min(open, kMostOpen - 1);
  const auto routines = open_routines(state);
  const bool interrupted = frame < routines.size() && routines[frame].interrupted;
  std::vector<Scope> scopes{
      {.name = "Logic stack", .variables = container(kLogicStack, frame), .memory = stack_reference(frame)},
      {.name = "AC",
       .variables = container(kAccumulators, frame),
       .memory = accumulators_reference(frame, interrupted),
       .registers = true}};
  for (const Area area : kShown)
    if (model.size_of(area) != 0)
      scopes.push_back({.name = std::string(info(area).name),
                        .variables = container(kArea, static_cast<Container>(area)),
                        .memory = std::string(info(area).name)});
  const std::uint32_t control = kPorts[simulation.port()].control - image::kSM;
  scopes.push_back({.name = "Port", .variables = container(kPort, 0), .memory = fmt::format("SMB{}", control)});
  scopes.push_back({.name = "Runtime", .variables = container(kRuntime, 0), .memory = "SMB0"});
  return scopes;
}

std::vector<Variable> variables_of(const serial::Simulation& simulation, const History& history, Container container) {
  const Cpu& cpu = simulation.cpu();
  const Container which = container & kWhich;
  switch (container >> kKindShift) {
    case kLogicStack:
      return logic_stack(cpu.state(), which);
    case kAccumulators:
      return accumulators(cpu, which);
    case kArea:
      return which < kAreas ? area_variables(cpu, static_cast<Area>(which)) : std::vector<Variable>{};
    case kPort:
      return port_variables(simulation);
    case kRuntime:
      return runtime(cpu, history);
    case kBits:
      return bits_of_byte(cpu, which);
    case kBlock:
      return block_of_v(cpu, which);
    default:
      return {};
  }
}

Variable variable_of(const Cpu& cpu, const MemoryRange& range, const std::string& name) {
  return {.name = name,
          .value = value_text(cpu.program(), range, forcing::seen_outside(cpu.state(), range)),
          .type = std::string(type_of(range)),
          .expression = name.substr(0, name.find(' ')),
          .memory = range.name_of(0),
          .settable = true};
}

std::vector<std::string> addresses_in(const Program& program) {
  std::map<std::tuple<Area, std::uint32_t, std::uint8_t, Width>, std::string> found;
  for (const stl::Statement& statement : program.statements)
    for (const stl::Operand& operand : statement.operands) {
      if (!std::holds_alternative<stl::Address>(operand.value)) continue;
      const std::string text = stl::to_text(operand);
      if (const auto range = range_of(text, program))
        found.emplace(std::tuple(range->area, range->at, range->bit, range->width), text);
    }
  std::vector<std::string> addresses;
  for (auto& [place, text] : found) addresses.push_back(std::move(text));
  return addresses;
}

}  // namespace s7200::tools::dap
