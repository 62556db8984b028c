// JSON that comes from outside: its values taken by their kind. What is wrong with one is thrown.
#pragma once

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "tools/json/json_number.hpp"
#include "tools/json/json_text.hpp"

namespace s7200::tools {

/// A value that is not what its place takes: `three: 3.5 is not a whole number from 0 to 255`.
class WrongValue : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Values by their kind. Each throws WrongValue for another kind.

template <class Number>
Number number_of(const nlohmann::ordered_json& value, Between<Number> range = kWhole<Number>) {
  const auto number = number_from<Number>(value);
  if (number && range.has(*number)) return *number;
  throw WrongValue(fmt::format("{} is not a{} number from {} to {}", shown(value),
                               std::is_floating_point_v<Number> ? "" : " whole", range.least, range.most));
}

/// A text without NUL, at which names would end for the system that they are handed to.
std::string text_of(const nlohmann::ordered_json& value);
bool truth_of(const nlohmann::ordered_json& value);

// Members of a map. One that is null counts as left out. The first forms throw WrongValue without it; all throw it, with
// the key in front, if it is of another kind.

/// Null if it is left out.
const nlohmann::ordered_json* member(const nlohmann::ordered_json& map, const char* key);
const nlohmann::ordered_json& required(const nlohmann::ordered_json& map, const char* key);

/// What `take` makes of a member; it may throw WrongValue.
template <class Take>
auto taken(const nlohmann::ordered_json& value, const char* key, Take take) {
  try {
    return take(value);
  } catch (const WrongValue& wrong) {
    throw WrongValue(fmt::format("{}: {}", key, wrong.what()));
  }
}

template <class Number>
Number number_at(const nlohmann::ordered_json& map, const char* key, Between<Number> range = kWhole<Number>) {
  return taken(required(map, key), key, [&](const auto& value) { return number_of<Number>(value, range); });
}
template <class Number>
Number number_at(const nlohmann::ordered_json& map, const char* key, Between<Number> range, Number otherwise) {
  return member(map, key) ? number_at<Number>(map, key, range) : otherwise;
}

std::string text_at(const nlohmann::ordered_json& map, const char* key);
std::string text_at(const nlohmann::ordered_json& map, const char* key, std::string_view otherwise);
bool truth_at(const nlohmann::ordered_json& map, const char* key);
bool truth_at(const nlohmann::ordered_json& map, const char* key, bool otherwise);

/// An empty list, or map, if it is left out.
const nlohmann::ordered_json& list_at(const nlohmann::ordered_json& map, const char* key);
const nlohmann::ordered_json& map_at(const nlohmann::ordered_json& map, const char* key);
const nlohmann::ordered_json& required_list(const nlohmann::ordered_json& map, const char* key);
const nlohmann::ordered_json& required_map(const nlohmann::ordered_json& map, const char* key);

/// A text, or a list of them; none if it is left out.
std::vector<std::string> texts_at(const nlohmann::ordered_json& map, const char* key);

}  // namespace s7200::tools
