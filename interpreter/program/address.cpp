#include "interpreter/program/address.hpp"

#include <fmt/format.h>

#include <bit>

#include "interpreter/base/numbers.hpp"
#include "interpreter/base/text.hpp"
#include "interpreter/program/operands.hpp"
#include "interpreter/stl/parser.hpp"

namespace s7200 {
namespace {

/// One operand in STL notation.
std::optional<stl::OperandValue> parse_operand(std::string_view text) {
  if (text.find_first_of("\n\r,;/ \t") != std::string_view::npos) return {};
  const stl::ParseResult parsed = stl::parse(std::string("LD ").append(text), "");
  if (!parsed.diagnostics.empty() || parsed.source.lines.size() != 1) return {};
  const auto* statement = std::get_if<stl::Statement>(&parsed.source.lines[0]);
  if (!statement || statement->operands.size() != 1) return {};
  return statement->operands[0].value;
}

std::uint32_t place_of(const MemoryRange& range) {
  const AreaInfo& area = info(range.area);
  const std::uint32_t element = std::max(1u, area.element);
  if (range.area == Area::AC) return area.base + 4 * range.number + 4u - bytes_of(range.width);
  return area.base + element * range.number;
}

/// What follows the first colon, in upper case: `4`, `REAL`, `4:REAL`.
bool read_suffix(std::string_view text, MemoryRange& range) {
  constexpr std::string_view kReal = "REAL";
  if (text.ends_with(kReal)) {
    if (range.width != Width::Double) return false;
    range.real = true;
    if (text == kReal) return true;
    text.remove_suffix(kReal.size());
    if (!text.ends_with(':')) return false;
    text.remove_suffix(1);
  }
  range.count = parse_decimal<std::uint32_t>(text).value_or(0);
  return range.count != 0 && range.width != Width::Bit;
}

}  // namespace

std::string MemoryRange::name_of(std::uint32_t i) const {
  const std::uint32_t step = info(area).element != 0 ? 1 : bytes_of(width);
  return address_text(area, width, number + i * step, bit);
}

std::optional<MemoryRange> parse_range(std::string_view text, const CpuModel& model, std::string& why) {
  const std::size_t colon = text.find(':');
  const auto operand = parse_operand(text.substr(0, colon));
  const auto* address = operand ? std::get_if<stl::Address>(&*operand) : nullptr;
  const auto area = address ? area_named(address->area) : std::nullopt;
  if (!area || !names_width(*address, *area)) {
    why =
        fmt::format("'{}' is not an address; write for example VB100, VW100:4, M31.7, AC0, VD20:real", stl::shortened(text));
    return {};
  }
  MemoryRange range{*area, width_of(*address, *area).value_or(Width::Double), address->number, address->bit};
  if (colon != std::string_view::npos && !read_suffix(stl::upper_case(text.substr(colon + 1)), range)) {
    why = fmt::format("'{}': after the colon write a count of 1 or more (not for bits), or real (only for double words)",
                      stl::shortened(text));
    return {};
  }
  const std::uint64_t size = model.size_of(*area);
  const std::uint64_t needed = info(*area).element != 0 ? std::uint64_t{range.number} + range.count
                                                        : range.number + std::uint64_t{range.count} * bytes_of(range.width);
  if (needed > size) {
    why = fmt::format("'{}' does not exist on CPU {}: {} memory has {} {}", stl::shortened(text), model.name,
                      info(*area).name, size, info(*area).element ? "elements" : "bytes");
    return {};
  }
  range.at = place_of(range);
  return range;
}

std::optional<Assignment> parse_assignment(std::string_view text, const CpuModel& model, std::string& why) {
  const std::size_t equals = text.find('=');
  const auto place = parse_range(text.substr(0, equals), model, why);
  if (!place) return {};
  const auto value = equals == std::string_view::npos ? std::nullopt : parse_operand(text.substr(equals + 1));
  if (value && place->count == 1) {
    if (const auto* real = std::get_if<stl::Real>(&*value); real && place->width == Width::Double) {
      Assignment assignment{*place, std::bit_cast<std::uint32_t>(real->value)};
      assignment.place.real = true;
      return assignment;
    }
    const int bits = place->width == Width::Bit ? 1 : 8 * static_cast<int>(bytes_of(place->width));
    const auto* integer = std::get_if<stl::Integer>(&*value);
    if (integer && place->real) return Assignment{*place, std::bit_cast<std::uint32_t>(static_cast<float>(integer->value))};
    const std::int64_t lowest = bits == 1 ? 0 : -(std::int64_t{1} << (bits - 1));
    if (integer && integer->value >= lowest && integer->value < (std::int64_t{1} << bits))
      return Assignment{*place, static_cast<std::uint32_t>(integer->value)};
  }
  why = fmt::format("'{}': write one address, =, and a value that fits it, for example VW100=5 or M31.7=1",
                    stl::shortened(text));
  return {};
}

}  // namespace s7200
