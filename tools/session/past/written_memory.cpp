#include "tools/session/past/written_memory.hpp"

#include <algorithm>

#include "interpreter/analysis/effects/effects.hpp"
#include "interpreter/model/area.hpp"
#include "interpreter/model/ports.hpp"

namespace s7200::tools {
namespace {

constexpr std::uint32_t kBlock = 32;  // bytes
constexpr std::size_t kBlocks = (image::kConstants + kBlock - 1) / kBlock;

/// Calls `act` with each block of the image that the bits are in.
template <class Act>
void each_block(const Bits& bits, const Act& act) {
  if (bits.count == 0) return;
  const std::uint64_t last = std::min<std::uint64_t>((bits.first + bits.count - 1) / 8 / kBlock, kBlocks - 1);
  for (std::uint64_t block = bits.first / 8 / kBlock; block <= last; ++block) act(static_cast<std::size_t>(block));
}

void add_all(std::vector<bool>& to, const std::vector<bool>& from) {
  for (std::size_t i = 0; i < from.size(); ++i)
    if (from[i]) to[i] = true;
}

/// RCV, NETR and NETW: what comes is stored as it comes.
bool receives_later(const Instruction& instruction) {
  return instruction.effect == Effect::Receives || instruction.mnemonic == "NETR" || instruction.mnemonic == "NETW";
}

bool may_copy_parameters(const Program& program, std::uint32_t number) {
  const Op& op = program.ops[number];
  return !program.parameters.empty() && (op.instruction->structure == Structure::Call || returns_from_subroutine(op));
}

}  // namespace

void WrittenMemory::add(const WrittenMemory& other) {
  add_all(executed, other.executed);
  add_all(blocks, other.blocks);
  unknown |= other.unknown;
}

WriteMarker::WriteMarker(const Cpu& cpu) : cpu_(cpu) {
  for (std::uint32_t op = 0; op < cpu.program().ops.size(); ++op) {
    writes_.push_back(writes_of(cpu.program(), op));
    receives_later_ |= receives_later(*cpu.program().ops[op].instruction);
  }
}

WrittenMemory WriteMarker::nothing() const {
  return {.executed = std::vector<bool>(writes_.size()), .blocks = std::vector<bool>(kBlocks)};
}

WriteMarker::Writes WriteMarker::writes_of(const Program& program, std::uint32_t number) {
  if (may_copy_parameters(program, number)) return Writes::Elsewhere;
  const Op& op = program.ops[number];
  const auto rules = op.instruction->rules();
  Writes writes = Writes::Operands;
  for (std::size_t i = 0; i < rules.size(); ++i) {
    const OperandRule& rule = rules[i];
    if (rule.kind != OperandKind::Memory || rule.role == Role::In) continue;
    if (rule.most != 0) return Writes::Unknown;
    if (op[i].pointer || rule.counted != 0) writes = Writes::Elsewhere;
  }
  return writes;
}

void WriteMarker::before(std::uint32_t op) {
  if (writes_[op] != Writes::Elsewhere) return;
  next_ = accessed(cpu_, op, Access::Write);
}

void WriteMarker::executed(const InstructionRecord& record, WrittenMemory& written) const {
  if (!record.powered) return;
  written.executed[record.op] = true;
  if (writes_[record.op] == Writes::Unknown) written.unknown = true;
  if (writes_[record.op] != Writes::Elsewhere) return;
  for (const Bits& bits : next_) each_block(bits, [&](std::size_t block) { written.blocks[block] = true; });
}

/// The system writes the rest of special memory, timers and counters, inputs and local memory whenever it likes.
bool WriteMarker::knows(const MemoryRange& range) const {
  if (range.area == Area::V || range.area == Area::M) return !receives_later_;
  const auto is_its_control = [&](const PortInfo& port) { return range.at == port.control; };
  return range.area == Area::SM && range.bytes() == 1 && std::ranges::any_of(kPorts, is_its_control);
}

std::vector<std::uint32_t> WriteMarker::writers_of(const Bits& range) const {
  std::vector<std::uint32_t> writers;
  for (std::uint32_t op = 0; op < writes_.size(); ++op)
    if (writes_[op] == Writes::Operands && accesses(cpu_, op, Access::Write, range)) writers.push_back(op);
  return writers;
}

bool WriteMarker::may_hold(const WrittenMemory& written, const Bits& range, const std::vector<std::uint32_t>& writers) {
  if (written.unknown) return true;
  bool led_there = false;
  each_block(range, [&](std::size_t block) { led_there |= written.blocks[block]; });
  return led_there || std::ranges::any_of(writers, [&](std::uint32_t op) { return written.executed[op]; });
}

}  // namespace s7200::tools
