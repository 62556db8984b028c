// Numbers of JSON from outside, as types of this program.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <type_traits>
#include <utility>

#include "interpreter/base/text/numbers.hpp"

namespace s7200::tools {

/// The value as a number that the type can hold; `1.0` and `1e3` are whole. Returns nothing for anything else.
template <class Number>
std::optional<Number> number_from(const nlohmann::ordered_json& value) {
  if (value.is_number_float()) {
    const auto real = value.get<double>();
    if constexpr (std::is_floating_point_v<Number>) return static_cast<Number>(real);
    constexpr double kBeyond = 0x1p63;  // a double has no number between this and the greatest that fits
    if (std::trunc(real) != real || real < -kBeyond || real >= kBeyond) return {};
    return number_from<Number>(static_cast<std::int64_t>(real));
  }
  if constexpr (std::is_floating_point_v<Number>) {
    if (value.is_number()) return static_cast<Number>(value.get<double>());
  } else {
    if (value.is_number_unsigned() && std::in_range<Number>(value.get<std::uint64_t>()))
      return static_cast<Number>(value.get<std::uint64_t>());
    if (value.is_number_integer() && !value.is_number_unsigned() && std::in_range<Number>(value.get<std::int64_t>()))
      return static_cast<Number>(value.get<std::int64_t>());
  }
  return {};
}

/// All that a type can hold.
template <class Number>
inline constexpr Between<Number> kWhole{std::numeric_limits<Number>::lowest(), std::numeric_limits<Number>::max()};

}  // namespace s7200::tools
