#include "interpreter/program/operands/operand_memory.hpp"

namespace s7200 {
namespace {

OperandMemory range_of(const stl::Address& address) {
  switch (address.size) {
    case stl::Size::None:
      return {address.area, address.number, std::uint64_t{address.number} + 1};
    case stl::Size::Bit: {
      const std::uint64_t bit = std::uint64_t{address.number} * 8 + address.bit;
      return {address.area, bit, bit + 1};
    }
    case stl::Size::Byte:
    case stl::Size::Word:
    case stl::Size::Double: {
      const std::uint64_t bytes = address.size == stl::Size::Byte ? 1 : address.size == stl::Size::Word ? 2 : 4;
      return {address.area, std::uint64_t{address.number} * 8, (address.number + bytes) * 8};
    }
  }
  return {};
}

bool is_constant(const stl::Operand& operand) {
  return std::holds_alternative<stl::Integer>(operand.value) || std::holds_alternative<stl::Real>(operand.value) ||
         std::holds_alternative<stl::AddressOf>(operand.value);
}

}  // namespace

std::optional<OperandMemory> memory_of(const stl::Operand& operand) {
  const auto* address = std::get_if<stl::Address>(&operand.value);
  return address ? std::optional(range_of(*address)) : std::nullopt;
}

bool changes(const stl::Operand& written, const stl::Operand& read) {
  const auto target = memory_of(written), source = memory_of(read);
  const auto* indirect = std::get_if<stl::Indirect>(&read.value);
  return target && ((source && target->overlaps(*source)) || (indirect && target->overlaps(range_of(indirect->pointer))));
}

bool may_change(const stl::Operand& written, const stl::Operand& read) {
  if (is_constant(read)) return false;
  const auto target = memory_of(written);
  if (!target) return true;
  const bool through_pointer = !memory_of(read) && target->area != "AC";  // no pointer leads to an accumulator
  return changes(written, read) || through_pointer;
}

}  // namespace s7200
