#include "interpreter/analysis/effects/sources.hpp"

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "interpreter/analysis/effects/effects.hpp"
#include "interpreter/analysis/effects/value_boxes.hpp"

namespace s7200 {
namespace {

constexpr std::uint64_t kFirstConstant = std::uint64_t{image::kConstants} * 8;

/// Also those that move whole blocks.
bool moves_values(const Instruction& instruction) {
  const auto box = value_box_of(instruction);
  const std::string_view mnemonic = instruction.mnemonic;
  return (box && box->carries()) || mnemonic == "MOVR" || mnemonic == "BMB" || mnemonic == "BMW" || mnemonic == "BMD";
}

std::optional<Bits> bits_now(const Program& program, std::uint32_t number, std::uint8_t operand,
                             std::span<const std::uint8_t> image) {
  const Op& op = program.ops[number];
  if (op[operand].unread()) return {};
  if (!op[operand].pointer && op[operand].at >= image::kConstants)
    return Bits{std::uint64_t{op[operand].at} * 8, 8 * bytes_of(op.instruction->operand[operand].width)};
  for (const MemoryAccess& access : effects_now(program, number, image))
    if (access.operand == operand && access.by_pointer == op[operand].pointer) return access.bits;
  return {};
}

/// Of two widths the bytes of lowest value are moved: those at the end.
std::optional<Bits> moved_from(const Bits& in, const Bits& out, const Bits& written) {
  const std::uint64_t count = std::min(in.count, out.count), first = out.end() - count;
  const Bits asked{std::max(first, written.first), std::min(out.end(), written.end()) - std::max(first, written.first)};
  if (written.first >= out.end() || written.end() <= first) return {};
  return Bits{in.end() - count + (asked.first - first), asked.count};
}

/// Data enters at the first bit, with a negative count at the last one.
std::optional<Bits> shifted_from(const Op& op, std::int8_t count, const Bits& written) {
  if (written.count != 1 || count == 0) return {};
  const std::uint64_t first = std::uint64_t{op[1].at} * 8 + op[1].bit;
  const auto length = static_cast<std::uint64_t>(std::abs(int{count}));
  const std::uint64_t enters = count > 0 ? first : first + length - 1;
  if (written.first < first || written.first >= first + length) return {};
  if (written.first == enters) return Bits{std::uint64_t{op[0].at} * 8 + op[0].bit, 1};
  return Bits{count > 0 ? written.first - 1 : written.first + 1, 1};
}

}  // namespace

std::optional<Bits> source_of(const Program& program, std::uint32_t op, const Bits& written,
                              std::span<const std::uint8_t> image) {
  const Op& now = program.ops[op];
  if (now.instruction->mnemonic == "SHRB") {
    const auto count = bits_now(program, op, 2, image);
    if (!count || now[0].unread() || now[1].unread()) return {};
    const std::uint64_t at = count->first / 8;
    const bool constant = count->first >= kFirstConstant;
    return shifted_from(now, static_cast<std::int8_t>(constant ? program.constants[at - image::kConstants] : image[at]),
                        written);
  }
  if (!moves_values(*now.instruction)) return {};
  const auto in = bits_now(program, op, 0, image), out = bits_now(program, op, 1, image);
  return in && out ? moved_from(*in, *out, written) : std::nullopt;
}

std::optional<bool> constant_bit(const Program& program, const Bits& bits) {
  if (bits.first < kFirstConstant) return {};
  return (program.constants[static_cast<std::size_t>((bits.first - kFirstConstant) / 8)] >> bits.first % 8 & 1) != 0;
}

}  // namespace s7200
