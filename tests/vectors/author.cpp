#include "tests/vectors/author.hpp"

#include <array>
#include <map>
#include <stdexcept>

#include "interpreter/stl/parser.hpp"

namespace s7200::vectors {
namespace {

using reference::Bytes;
using reference::Machine;
using reference::Memory;

constexpr int kWatchdog = 3;

struct NamedArea {
  std::string name;
  Bytes Memory::*bytes;
};

const std::array<NamedArea, 17> kAreas{{{"V", &Memory::V},
                                        {"L", &Memory::L},
                                        {"I", &Memory::I},
                                        {"Q", &Memory::Q},
                                        {"M", &Memory::M},
                                        {"SM", &Memory::SM},
                                        {"S", &Memory::S},
                                        {"T", &Memory::T},
                                        {"T.bit", &Memory::timer_bits},
                                        {"C", &Memory::C},
                                        {"C.bit", &Memory::counter_bits},
                                        {"HC", &Memory::HC},
                                        {"AC", &Memory::AC},
                                        {"AI", &Memory::AI},
                                        {"AQ", &Memory::AQ},
                                        {"PI", &Memory::input_points},
                                        {"PQ", &Memory::output_points}}};

Bytes& area_of(Memory& memory, const std::string& name) {
  for (const NamedArea& area : kAreas)
    if (area.name == name) return memory.*area.bytes;
  throw std::runtime_error("no area " + name);
}

stl::Source source_of(const Case& what) {
  std::string text;
  for (const std::string& op : what.ops) text += op + "\n";
  if (what.ops.size() == 1) text += "MEND\n";
  stl::ParseResult parsed = stl::parse(text, what.title);
  if (!parsed.diagnostics.empty()) throw std::runtime_error("not STL: " + text);
  return std::move(parsed.source);
}

reference::Stack stack_of(const Levels& levels) {
  reference::Stack stack{};
  for (std::size_t i = 0; i < levels.size(); ++i) stack[i] = levels[i];
  return stack;
}

Levels levels_of(const reference::Stack& stack) {
  Levels levels(stack.begin(), stack.end());
  while (levels.size() > 1 && !levels.back()) levels.pop_back();
  return levels;
}

/// At the start of the first scan's program, with memory and logic stack as the case wants them.
Machine prepared(const Case& what, std::uint8_t smb1, const std::string& cpu) {
  Machine machine(source_of(what), reference::cpu_kind(cpu));
  machine.power_up();
  machine.step();
  machine.stack = stack_of(what.stack);
  machine.memory.SM[1] = smb1;
  for (const std::string& text : what.before) {
    const auto assignment = parse_assignment(text);
    if (!assignment) throw std::runtime_error("no assignment: " + text);
    assign(machine.memory, *assignment);
  }
  return machine;
}

void run(Machine& machine, const Case& what) {
  for (std::uint32_t i = 0; what.until == 0 && i < what.steps; ++i) machine.step();
  while (what.until != 0 && (machine.time < what.until || !machine.in_program)) machine.step();
  machine.count_milliseconds();
}

/// How the flags concerned must be before, so that each of them changes; the others are as in `others`.
std::uint8_t opposite_flags(const Case& what, std::uint8_t others, const std::string& cpu) {
  if (what.flags == 0) return 0;
  Machine machine = prepared(what, others, cpu);
  run(machine, what);
  return static_cast<std::uint8_t>((others & ~what.flags) | (~machine.memory.SM[1] & what.flags));
}

// --- what has changed ---

bool is_numbered(const std::string& area) { return area == "T" || area == "C" || area == "AC" || area == "HC"; }

/// The size in bytes of the objects as which the differing bytes of an area are written, from `at`.
std::uint8_t width_at(const std::string& area, const std::vector<bool>& differs, std::size_t at) {
  if (is_numbered(area)) return area == "T" || area == "C" ? 2 : 4;
  if (area == "AI" || area == "AQ") return 2;
  std::size_t run = 0;
  while (at + run < differs.size() && differs[at + run]) ++run;
  return run >= 4 ? 4 : run >= 2 ? 2 : 1;
}

void add_bits(const NamedArea& area, const Bytes& before, const Bytes& after, std::vector<Assignment>& result) {
  for (std::uint32_t at = 0; at < after.size(); ++at)
    for (std::uint8_t bit = 0; bit < 8; ++bit)
      if (((before[at] ^ after[at]) >> bit) & 1)
        result.push_back({area.name, at, 0, bit, static_cast<unsigned>(after[at] >> bit) & 1u});
}

void add_bytes(const NamedArea& area, const Bytes& before, Bytes& after, std::vector<Assignment>& result) {
  std::vector<bool> differs;
  for (std::size_t i = 0; i < after.size(); ++i) differs.push_back(before[i] != after[i]);
  for (std::size_t at = 0; at < after.size();) {
    if (!differs[at]) {
      ++at;
      continue;
    }
    const std::uint8_t width = width_at(area.name, differs, at);
    if (is_numbered(area.name) || area.name == "AI" || area.name == "AQ") at -= at % width;
    result.push_back({area.name, static_cast<std::uint32_t>(at), width, 0, read(reference::Place{&after, at}, width)});
    at += width;
  }
}

/// Whether an area reads better bit by bit: flags, and what a bit instruction has changed.
bool in_bits(const std::string& area, const Case& what) {
  if (area == "SM" && what.until == 0) return true;
  if (area.ends_with(".bit")) return true;
  for (const std::string& text : what.before)
    if (const auto assignment = parse_assignment(text); assignment && assignment->area == area && assignment->width == 0)
      return true;
  return false;
}

/// Objects named in `before` are named again as a whole if a part of them has changed.
std::vector<Assignment> changes(Memory before, Memory after, const Case& what) {
  std::vector<Assignment> result;
  for (const std::string& text : what.before) {
    Assignment object = *parse_assignment(text);
    if (object.width == 0) continue;
    const reference::Place old{&area_of(before, object.area), object.at}, now{&area_of(after, object.area), object.at};
    const std::uint32_t value = read(now, object.width);
    if (read(old, object.width) == value) continue;
    object.value = value;
    write(old, object.width, value);
    result.push_back(object);
  }
  for (const NamedArea& area : kAreas) {
    if (in_bits(area.name, what))
      add_bits(area, before.*area.bytes, after.*area.bytes, result);
    else
      add_bytes(area, before.*area.bytes, after.*area.bytes, result);
  }
  return result;
}

}  // namespace

void assign(Memory& memory, const Assignment& a) {
  Bytes& bytes = area_of(memory, a.area);
  if (a.width == 0)
    write(reference::BitPlace{&bytes, std::size_t{8} * a.at + a.bit}, a.value != 0);
  else
    write(reference::Place{&bytes, a.at}, a.width, a.value);
}

Vector execute(const Case& what, const std::string& source, const std::string& cpu) {
  const std::uint8_t smb1 = opposite_flags(what, what.flags != 0 && what.before.size() % 2 == 0 ? 0xFF : 0x00, cpu);
  Machine machine = prepared(what, smb1, cpu);
  const Memory before = machine.memory;
  const std::int64_t start = machine.time;
  run(machine, what);

  Vector vector;
  vector.cpu = cpu;
  vector.title = what.title;
  vector.ops = what.ops;
  for (const std::string& text : what.before) vector.before.push_back(*parse_assignment(text));
  if (smb1 != 0) vector.before.push_back({"SM", 1, 1, 0, smb1});
  vector.stack = what.stack;
  vector.steps = what.until == 0 ? what.steps : 1;
  if (what.until != 0) vector.until = machine.time;
  vector.after = changes(before, machine.memory, what);
  vector.stops = !machine.running;
  vector.ends = machine.running && !machine.in_program;
  if (machine.in_program && (vector.is_program() || machine.position != 1))
    vector.next = static_cast<std::uint32_t>(machine.position);
  if (machine.in_program && machine.stack != stack_of(what.stack)) vector.leaves = levels_of(machine.stack);
  if (machine.error_count != 0) vector.error = machine.errors.front().code;
  vector.fatal = machine.fatal_code;
  if (what.until == 0 && vector.fatal != kWatchdog) vector.time = machine.time - start;
  vector.source = source;
  return vector;
}

}  // namespace s7200::vectors
