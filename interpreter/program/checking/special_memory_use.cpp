#include "interpreter/program/checking/special_memory_use.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "interpreter/program/checking/warnings.hpp"
#include "interpreter/stl/printer.hpp"

namespace s7200 {
namespace {

const SpecialMemory* row_of(std::uint32_t byte) {
  const auto row = std::ranges::find_if(special_memory(), [&](const SpecialMemory& r) { return byte <= r.last; });
  return row == special_memory().end() ? nullptr : &*row;
}

/// The first row among the bytes that the CPU has, but makes no use of; null if there is none.
const SpecialMemory* unused_row(const CpuModel& model, const SpecialBytes& bytes) {
  const auto row = std::ranges::find_if(
      special_memory(), [&](const SpecialMemory& r) { return r.on(model) != SpecialUse::Modelled && bytes.overlap(r); });
  return row == special_memory().end() ? nullptr : &*row;
}

/// The number of bytes, from the first one on, that the CPU makes use of.
std::uint32_t used_at_first(const CpuModel& model, const SpecialBytes& bytes) {
  std::uint32_t used = 0;
  while (used < bytes.count && is_modelled_special_memory(model, bytes.first + used)) ++used;
  return used;
}

/// The constant that a move writes; null for anything else.
const stl::Integer* moved_constant(const stl::Statement& statement, std::size_t operand) {
  const bool moves = operand == 1 && (statement.mnemonic == "MOVW" || statement.mnemonic == "MOVD");
  return moves ? std::get_if<stl::Integer>(&statement.operands[0].value) : nullptr;
}

/// The values that the first bytes of a double word or word get: `0, 0`.
std::string first_bytes_of(std::int64_t value, std::uint32_t width, std::uint32_t count) {
  std::vector<std::int64_t> bytes;
  for (std::uint32_t i = 0; i < count; ++i) bytes.push_back(value >> 8 * (width - 1 - i) & 0xFF);
  return fmt::format("{}", fmt::join(bytes, ", "));
}

std::string smb_text(std::uint32_t first, std::uint32_t last) {
  return first == last ? fmt::format("SMB{}", first) : fmt::format("SMB{} to SMB{}", first, last);
}

/// `MOVW 100, SMW94`, where SMB94 is used and SMB95 is not.
void warn_of_wide_write(const SpecialBytes& bytes, std::uint32_t used, const stl::Statement& statement, std::size_t operand,
                        stl::Diagnostics& diagnostics) {
  const stl::Integer* constant = moved_constant(statement, operand);
  const std::string what = constant    ? first_bytes_of(constant->value, bytes.count, used)
                           : used == 1 ? "the high byte of what it writes"
                                       : "the upper bytes of what it writes";
  const std::string where = used == 1
                                ? fmt::format("SMB{} is a byte", bytes.first)
                                : fmt::format("{} are all that is used here", smb_text(bytes.first, bytes.first + used - 1));
  const bool fits = constant && constant->value >= -128 && constant->value <= 255;
  const std::string instead = fits ? fmt::format("write MOVB {}, SMB{}", stl::to_text(statement.operands[0]), bytes.first)
                                   : fmt::format("write SMB{} with a byte instruction such as MOVB", bytes.first);
  diagnostics.push_back(warn(Warning::UnusedSpecialMemory, statement.operands[operand].position,
                             fmt::format("{}: this writes {} into {}", where, what, used == 1 ? "it" : "them"),
                             used == 1 ? instead : "write each with an instruction of its own width"));
}

}  // namespace

const SpecialMemory* refused_special_memory(const CpuModel& model, const SpecialBytes& bytes) {
  const auto row = std::ranges::find_if(
      special_memory(), [&](const SpecialMemory& r) { return r.on(model) == SpecialUse::Refused && bytes.overlap(r); });
  return row == special_memory().end() ? nullptr : &*row;
}

bool is_modelled_special_memory(const CpuModel& model, std::uint32_t byte) {
  const SpecialMemory* row = byte < model.size_of(Area::SM) ? row_of(byte) : nullptr;
  return row && row->on(model) == SpecialUse::Modelled;
}

std::string bytes_text(const SpecialMemory& memory) { return smb_text(memory.first, memory.last); }

void warn_of_special_memory(const CpuModel& model, const SpecialBytes& bytes, const OperandRule& rule,
                            const stl::Statement& statement, std::size_t operand, stl::Diagnostics& diagnostics) {
  const SpecialMemory* row = unused_row(model, bytes);
  if (!row) return;
  const std::uint32_t used = used_at_first(model, bytes);
  const bool wide_write = rule.role != Role::In && bytes.count > 1 && bytes.count == bytes_of(rule.width);
  if (used != 0 && wide_write) return warn_of_wide_write(bytes, used, statement, operand, diagnostics);
  const bool still = row->on(model) == SpecialUse::Still;
  const std::string name = bytes_text(*row);
  diagnostics.push_back(warn(Warning::UnusedSpecialMemory, statement.operands[operand].position,
                             still ? fmt::format("{}: the CPU leaves {} ({}) as they are", row->why, name, row->meaning)
                                   : fmt::format("CPU {} makes no use of {} ({})", model.name, name, row->meaning),
                             still ? "" : "it is memory like V and M, as far as the manual says; check the address", name));
}

}  // namespace s7200
