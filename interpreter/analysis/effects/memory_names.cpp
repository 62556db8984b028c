#include "interpreter/analysis/effects/memory_names.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/program/operands/address.hpp"
#include "interpreter/program/operands/operands.hpp"
#include "interpreter/stl/printer.hpp"

namespace s7200 {
namespace {

std::uint64_t first_bit_of(std::uint32_t place) { return std::uint64_t{place} * 8; }

/// The part of the image whose bits stand for memory elsewhere: each of them for `unit` bits of what begins at `named`.
struct Alias {
  std::uint32_t from, bytes, named;
  std::uint64_t unit;
};
constexpr Alias kAliases[]{{image::kTBits, image::kTimers / 8, image::kT, 16},
                           {image::kCBits, image::kCounters / 8, image::kC, 16},
                           {image::kInputs, image::kPointBytes, image::kI, 1},
                           {image::kOutputs, image::kPointBytes, image::kQ, 1}};

std::string element_text(const AreaInfo& area, const Bits& bits) {
  const std::uint64_t size = std::uint64_t{area.element} * 8;
  const auto first = static_cast<std::uint32_t>((bits.first - first_bit_of(area.base)) / size);
  const auto last = static_cast<std::uint32_t>((bits.end() - 1 - first_bit_of(area.base)) / size);
  const std::string text = address_text(area.area, Width::Word, first, 0);
  return first == last ? text : fmt::format("{} to {}", text, address_text(area.area, Width::Word, last, 0));
}

std::string bit_text(const AreaInfo& area, std::uint64_t bit) {
  const std::uint64_t number = bit - first_bit_of(area.base);
  return address_text(area.area, Width::Bit, static_cast<std::uint32_t>(number / 8), static_cast<std::uint8_t>(number % 8));
}

}  // namespace

Bits as_named(const Bits& bits) {
  for (const Alias& alias : kAliases)
    if (Bits{first_bit_of(alias.from), std::uint64_t{alias.bytes} * 8}.contains(bits))
      return {first_bit_of(alias.named) + (bits.first - first_bit_of(alias.from)) * alias.unit, bits.count * alias.unit};
  const Bits accumulators{first_bit_of(image::kAC), 4 * 32};
  if (!accumulators.contains(bits)) return bits;
  const std::uint64_t first = bits.first / 32 * 32, end = (bits.end() + 31) / 32 * 32;
  return {first, end - first};
}

Area area_of(const Bits& bits) { return area_at(static_cast<std::uint32_t>(bits.first / 8)).area; }

std::string memory_text(const Bits& bits) {
  const AreaInfo& area = info(area_of(bits));
  if (area.element != 0) return element_text(area, bits);
  if (bits.count == 1) return bit_text(area, bits.first);
  if (bits.first % 8 != 0 || bits.count % 8 != 0)
    return fmt::format("{} to {}", bit_text(area, bits.first), bit_text(area, bits.end() - 1));
  const auto number = static_cast<std::uint32_t>(bits.first / 8 - area.base);
  const auto bytes = static_cast<std::uint32_t>(bits.count / 8);
  for (const Width width : {Width::Byte, Width::Word, Width::Double})
    if (bytes == bytes_of(width)) return address_text(area.area, width, number, 0);
  return fmt::format("{} to {}", address_text(area.area, Width::Byte, number, 0),
                     address_text(area.area, Width::Byte, number + bytes - 1, 0));
}

std::string pointer_text(std::uint32_t at) {
  if (area_at(at).area == Area::SM) return memory_text({at * 8u, 16});
  return "*" + memory_text(as_named({at * 8u, 32}));
}

Bits bits_of_area(const CpuModel& model, Area area) {
  return {first_bit_of(info(area).base), std::uint64_t{model.size_of(area)} * info(area).step() * 8};
}

std::optional<Bits> bits_of(const Program& program, const stl::Symbol& symbol) {
  if (!symbol.value || !std::holds_alternative<stl::Address>(*symbol.value)) return {};
  const auto range = parse_range(stl::to_text(stl::Operand{*symbol.value}), AddressSpace(*program.model));
  if (!range) return {};
  if (range->width == Width::Bit) return Bits{first_bit_of(range->at) + range->bit, 1};
  return as_named({first_bit_of(range->at), std::uint64_t{range->bytes()} * 8});
}

}  // namespace s7200
