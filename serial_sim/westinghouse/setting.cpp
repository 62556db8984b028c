#include "serial_sim/westinghouse/setting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"

namespace s7200::westinghouse {
namespace {

std::optional<std::uint32_t> parse_number(std::string_view text, int base) {
  std::uint32_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, value, base);
  if (error != std::errc{} || stopped != end) return {};
  return value;
}

/// Parses a drop's address, as in `00.11.00`.
std::optional<std::uint32_t> parse_drop(std::string_view text) {
  constexpr std::size_t kLength = 8;
  if (text.size() != kLength || text[2] != '.' || text[5] != '.') return {};
  const auto highway = parse_number(text.substr(0, 2), 16), drop = parse_number(text.substr(3, 2), 16),
             subdrop = parse_number(text.substr(6, 2), 16);
  if (!highway || !drop || !subdrop) return {};
  return *highway << 16 | *drop << 8 | *subdrop;
}

std::optional<std::uint32_t> parse_as(const SettingForm& form, std::string_view text) {
  using enum SettingForm::Notation;
  switch (form.notation) {
    case Word: {
      const auto found = std::ranges::find(form.words, text);
      return found == form.words.end() ? std::nullopt
                                       : std::optional(static_cast<std::uint32_t>(found - form.words.begin()));
    }
    case Decimal:
      return parse_number(text, 10);
    case Hex:
      return parse_number(text, 16);
    case Drop:
      return parse_drop(text);
    case DropOrNone:
      return text.empty() ? kNowhere : parse_drop(text);
  }
  return {};
}

}  // namespace

Result<std::uint32_t> parse_value(const SettingForm& form, std::string_view text) {
  using enum SettingForm::Notation;
  const auto value = parse_as(form, text);
  const bool drop = form.notation == Drop || form.notation == DropOrNone;
  if (value && (form.notation == Word || drop || (*value >= form.least && *value <= form.most))) return *value;
  const std::string shown = stl::shortened(text);
  if (form.notation == Word) return trouble("{}: '{}' is not one of {}", form.name, shown, fmt::join(form.words, ", "));
  if (drop) return trouble("{}: '{}' is not a drop; write highway, drop and subdrop in hex: 00.11.00", form.name, shown);
  return trouble("{}: '{}' is not a {} number from {} to {}", form.name, shown,
                 form.notation == Hex ? "hexadecimal" : "decimal", value_text(form, form.least),
                 value_text(form, form.most));
}

std::string value_text(const SettingForm& form, std::uint32_t value) {
  using enum SettingForm::Notation;
  switch (form.notation) {
    case Word:
      return std::string(form.words.at(value));
    case Decimal:
      return std::to_string(value);
    case Hex:
      return fmt::format("{:0{}X}", value, form.most > UINT16_MAX ? 5 : form.most > UINT8_MAX ? 4 : 2);
    case Drop:
    case DropOrNone:
      return value == kNowhere ? "" : fmt::format("{:02X}.{:02X}.{:02X}", value >> 16, value >> 8 & 0xFF, value & 0xFF);
  }
  return {};
}

std::optional<CellsText> parse_cells(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) return {};
  const std::string_view place = text.substr(0, equals);
  const std::size_t bracket = place.find('[');
  CellsText cells;
  cells.by_address = bracket != std::string_view::npos;
  const auto is_digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  const auto digits =
      cells.by_address ? place.begin() + static_cast<std::ptrdiff_t>(bracket) : std::ranges::find_if(place, is_digit);
  cells.name.assign(place.begin(), digits);
  std::string_view number = place.substr(cells.name.size());
  if (cells.by_address) {
    if (!number.ends_with(']')) return {};
    number = number.substr(1, number.size() - 2);
  }
  const auto first = parse_number(number, cells.by_address ? 16 : 10);
  if (!first || cells.name.empty()) return {};
  cells.first = *first;
  std::string_view rest = text.substr(equals + 1);
  for (;;) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    const auto value = parse_number(rest.substr(0, comma), 16);
    if (!value) return {};
    cells.values.push_back(*value);
    if (comma == rest.size()) return cells;
    rest.remove_prefix(comma + 1);
  }
}

}  // namespace s7200::westinghouse
