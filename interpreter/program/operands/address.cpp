#include "interpreter/program/operands/address.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <utility>
#include <vector>

#include "interpreter/base/text/nearest.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/program/operands/operands.hpp"
#include "interpreter/stl/parser.hpp"
#include "interpreter/stl/tables/symbols.hpp"
#include "interpreter/stl/text/look_alikes.hpp"

namespace s7200 {
namespace {

/// An address as written, or that of a symbol. `S1`, `E1` and the like are symbols if there are any of these names.
std::optional<stl::Address> find_address(std::string_view text, const AddressSpace& space) {
  const auto operand = stl::parse_operand(text);
  const bool complete =
      operand && std::holds_alternative<stl::Address>(operand->value) && !stl::may_be_name(operand->value, text);
  const stl::Symbol* symbol = space.symbols && !complete ? stl::find_symbol(*space.symbols, text) : nullptr;
  if (const auto* address = symbol && symbol->value ? std::get_if<stl::Address>(&*symbol->value) : nullptr) return *address;
  const auto* address = operand ? std::get_if<stl::Address>(&operand->value) : nullptr;
  return address ? std::optional(*address) : std::nullopt;
}

/// An address as other systems write it: with a % before it, blanks in it, or as one of the data block that V memory is,
/// `%VW10`, `VW 10`, `DB1.DBW10`, `DB1.DBX10.0`.
std::string in_own_form(std::string_view text) {
  constexpr std::string_view kDataBlock = "DB1.DB";
  std::string plain(stl::trim(text));
  if (plain.starts_with('%')) plain.erase(0, 1);
  const auto letters = static_cast<std::size_t>(std::ranges::find_if_not(plain, stl::is_letter) - plain.begin());
  const std::size_t number = plain.find_first_of(" \t");
  if (number == letters && number < 4) {
    const std::size_t digit = plain.find_first_not_of(" \t", number);
    if (digit != plain.npos && stl::is_digit(plain[digit])) plain.erase(number, digit - number);
  }
  if (stl::upper_case(plain).starts_with(kDataBlock))
    plain.replace(0, kDataBlock.size() + (stl::upper_case(plain).starts_with("DB1.DBX") ? 1 : 0), "V");
  return plain;
}

/// Why a text names no memory, and what to write.
std::string why_no_address(std::string_view text, const AddressSpace& space) {
  const std::string shown = stl::shortened(text);
  constexpr std::string_view kExamples = "write for example VB100, VW100:4, M31.7, AC0, VD20:real";
  if (!space.symbols || space.symbols->empty()) return fmt::format("'{}' is not an address; {}", shown, kExamples);
  if (stl::find_symbol(*space.symbols, text)) return fmt::format("'{}' is the symbol of a constant, not of memory", shown);
  std::vector<std::string_view> names;
  for (const stl::Symbol& symbol : *space.symbols) names.push_back(symbol.name);
  const std::string_view meant = nearest(text, names);
  return fmt::format("'{}' is not an address or a symbol; {}", shown,
                     meant.empty() ? std::string(kExamples) : fmt::format("did you mean {}?", stl::printable(meant)));
}

/// `Pump` of `Pump:Q0.0`, with the address beside it; otherwise nothing.
std::optional<std::string_view> beside_symbol(std::string_view text, std::size_t colon, const AddressSpace& space) {
  if (colon == std::string_view::npos || !space.symbols || !stl::find_symbol(*space.symbols, text.substr(0, colon)))
    return {};
  const std::string_view rest = text.substr(colon + 1);
  const auto operand = stl::parse_operand(rest.substr(0, rest.find(':')));
  return operand && std::holds_alternative<stl::Address>(operand->value) ? std::optional(rest) : std::nullopt;
}

std::uint32_t place_of(const MemoryRange& range) {
  const AreaInfo& area = info(range.area);
  const std::uint32_t element = std::max(1u, area.element);
  if (range.area == Area::AC) return area.base + 4 * range.number + 4u - bytes_of(range.width);
  return area.base + element * range.number;
}

/// The least and the largest value that is written for memory: a number with its sign, or its bits.
std::pair<std::int64_t, std::int64_t> values_of(Width width) {
  if (width == Width::Bit) return {0, 1};
  const int bits = 8 * static_cast<int>(bytes_of(width));
  return {-(std::int64_t{1} << (bits - 1)), (std::int64_t{1} << bits) - 1};
}

/// The value that a word for a switch stands for: `on`, `false`.
std::optional<std::uint32_t> bit_of_word(std::string_view text) {
  const std::string word = stl::upper_case(text);
  if (word == "ON" || word == "TRUE") return 1;
  return word == "OFF" || word == "FALSE" ? std::optional(0U) : std::nullopt;
}

bool is_integer(std::string_view text) {
  const auto operand = stl::parse_operand(text);
  return operand && std::holds_alternative<stl::Integer>(operand->value);
}

/// What follows the first colon, in upper case: `4`, `REAL`, `4:REAL`, `REAL:4`.
bool read_suffix(std::string_view text, MemoryRange& range) {
  constexpr std::string_view kReal = "REAL", kRealFirst = "REAL:", kRealLast = ":REAL";
  range.real = text == kReal || text.starts_with(kRealFirst) || text.ends_with(kRealLast);
  if (range.real && range.width != Width::Double) return false;
  if (text == kReal) return true;
  if (text.starts_with(kRealFirst))
    text.remove_prefix(kRealFirst.size());
  else if (range.real)
    text.remove_suffix(kRealLast.size());
  range.count = parse_decimal<std::uint32_t>(text).value_or(0);
  return range.count != 0 && range.width != Width::Bit;
}

}  // namespace

std::string MemoryRange::name_of(std::uint32_t i) const {
  const std::uint32_t step = info(area).element != 0 ? 1 : bytes_of(width);
  return address_text(area, width, number + i * step, bit);
}

std::vector<std::uint8_t> MemoryRange::bytes_in(std::span<const std::uint8_t> image) const {
  if (width == Width::Bit) return {static_cast<std::uint8_t>((image[at] >> bit) & 1)};
  const auto found = image.subspan(at, bytes());
  return {found.begin(), found.end()};
}

Result<MemoryRange> parse_range(std::string_view text, const AddressSpace& space) {
  const std::string own = text.starts_with('"') ? std::string(text) : in_own_form(text);
  text = own;
  const std::size_t colon = text.find(':', text.starts_with('"') ? text.find('"', 1) : 0);
  if (const auto address = beside_symbol(text, colon, space)) return parse_range(*address, space.model);
  const auto address = find_address(text.substr(0, colon), space);
  const auto area = address ? area_named(address->area) : std::nullopt;
  if (!area || !names_width(*address, *area)) return Trouble{why_no_address(text.substr(0, colon), space)};
  MemoryRange range{*area, width_of(*address, *area).value_or(Width::Double), address->number, address->bit};
  if (colon != std::string_view::npos && !read_suffix(stl::upper_case(text.substr(colon + 1)), range))
    return trouble("'{}': after the colon write a count of 1 or more (not for bits), or real (only for double words)",
                   stl::shortened(text));
  const std::uint64_t size = space.model.size_of(*area);
  const std::uint64_t needed = info(*area).element != 0 ? std::uint64_t{range.number} + range.count
                                                        : range.number + std::uint64_t{range.count} * bytes_of(range.width);
  if (needed > size)
    return trouble("'{}' does not exist on CPU {}: {} memory has {} {}", stl::shortened(text), space.model.name,
                   info(*area).name, size, info(*area).element ? "elements" : "bytes");
  if ((range.area == Area::AI || range.area == Area::AQ) && range.number % 2 != 0)
    return trouble("{} is an odd address; analog values are at even ones: {}",
                   address_text(range.area, range.width, range.number, 0),
                   address_text(range.area, range.width, range.number - 1, 0));
  range.at = place_of(range);
  return range;
}

Result<std::uint32_t> parse_pointer(std::string_view text, const AddressSpace& space) {
  const auto target = parse_range(text.substr(1), space);
  if (!target) return target.trouble();
  const auto pointer = target->count == 1 && !target->real
                           ? pointer_to(space.model, target->area, target->width, target->number)
                           : std::nullopt;
  if (!pointer) return trouble("'{}': {}", stl::shortened(text), pointer_targets_text(space.model));
  return *pointer;
}

std::optional<Assignment> parse_value(const MemoryRange& place, std::string_view text) {
  text = stl::trim(text);
  if (place.width == Width::Bit && place.count == 1)
    if (const auto bit = bit_of_word(text)) return Assignment{place, *bit};
  const std::string here = stl::constant_here(text);  // `0x10`, `10h`
  const auto value = stl::parse_operand(here.empty() ? text : std::string_view(here));
  if (!value || place.count != 1) return {};
  if (const auto* real = std::get_if<stl::Real>(&value->value); real && place.width == Width::Double) {
    Assignment assignment{place, std::bit_cast<std::uint32_t>(real->value)};
    assignment.place.real = true;
    return assignment;
  }
  const auto* integer = std::get_if<stl::Integer>(&value->value);
  if (!integer) return {};
  if (place.real) return Assignment{place, std::bit_cast<std::uint32_t>(static_cast<float>(integer->value))};
  const auto [least, most] = values_of(place.width);
  if (integer->value < least || integer->value > most) return {};
  return Assignment{place, static_cast<std::uint32_t>(integer->value)};
}

std::string values_text(const MemoryRange& place) {
  if (place.real) return "a REAL is up to 3.4e38, of either sign";
  const auto [least, most] = values_of(place.width);
  const std::string text = fmt::format("a {} is {} to {}", name_of(place.width), least, most);
  if (place.area != Area::T || place.width != Width::Word) return text;
  return fmt::format("{}, and {} counts {}", text, place.name_of(0), format_duration(timer_base(place.number).base));
}

Result<Assignment> parse_assignment(std::string_view text, const AddressSpace& space) {
  const std::size_t equals = text.find('=', text.starts_with('"') ? text.find('"', 1) : 0);
  const auto place = parse_range(text.substr(0, equals), space);
  if (!place) return place.trouble();
  const std::string_view value = equals == std::string_view::npos ? "" : stl::trim(text.substr(equals + 1));
  if (value.starts_with('&') && place->count == 1 && place->width == Width::Double && !place->real) {
    const auto pointer = parse_pointer(value, space);
    if (!pointer) return pointer.trouble();
    return Assignment{*place, *pointer};
  }
  const auto assignment = equals == std::string_view::npos ? std::nullopt : parse_value(*place, value);
  if (assignment) return *assignment;
  if (is_integer(value) && place->count == 1 && !place->real)
    return trouble("'{}': write a value that fits it: {}", stl::shortened(text), values_text(*place));
  return trouble("'{}': write one address, =, and a value that fits it, for example VW100=5 or M31.7=1",
                 stl::shortened(text));
}

}  // namespace s7200
