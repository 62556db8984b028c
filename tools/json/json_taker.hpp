// JSON from outside where nothing can be thrown, as in WebAssembly: its values taken by their kind. The first mistake is
// kept, and a value that is wrong reads as 0, false or an empty text.
#pragma once

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <type_traits>

#include "tools/json/json_number.hpp"
#include "tools/json/json_text.hpp"

namespace s7200::tools {

class JsonTaker {
 public:
  using Json = nlohmann::ordered_json;

  bool fine() const { return why_.empty(); }
  /// What is wrong with the first value that is not what its place takes: `clock: month is missing`. Empty: nothing.
  const std::string& why() const { return why_; }
  void fail(std::string why) {
    if (why_.empty()) why_ = std::move(why);
  }

  template <class Number>
  Number number(const Json& value, Between<Number> range = kWhole<Number>) {
    const auto number = number_from<Number>(value);
    if (number && range.has(*number)) return *number;
    fail(fmt::format("{} is not a{} number from {} to {}", shown(value), std::is_floating_point_v<Number> ? "" : " whole",
                     range.least, range.most));
    return {};
  }
  /// A text without NUL, at which names would end for the system that they are handed to.
  std::string text(const Json& value);
  bool truth(const Json& value);

  // Members of a map, and elements of a list. A member that is null counts as left out.

  /// JSON's null if it is left out, which is a mistake.
  const Json& member(const Json& map, const char* key);
  const Json& element(const Json& list, std::size_t number);

  /// What `take` makes of a value; its mistakes have the key in front.
  template <class Take>
  auto of(const char* key, const Json& value, Take take) {
    const bool was_fine = fine();
    auto taken = take(value);
    if (was_fine && !fine()) why_ = fmt::format("{}: {}", key, why_);
    return taken;
  }

  template <class Number>
  Number number_at(const Json& map, const char* key, Between<Number> range = kWhole<Number>) {
    const Json& value = member(map, key);
    return value.is_null() ? Number{} : of(key, value, [&](const Json& one) { return number<Number>(one, range); });
  }
  template <class Number>
  Number number_at(const Json& map, const char* key, Between<Number> range, Number otherwise) {
    return has(map, key) ? number_at<Number>(map, key, range) : otherwise;
  }
  std::string text_at(const Json& map, const char* key);
  std::string text_at(const Json& map, const char* key, std::string_view otherwise) {
    return has(map, key) ? text_at(map, key) : std::string(otherwise);
  }
  bool truth_at(const Json& map, const char* key);
  bool truth_at(const Json& map, const char* key, bool otherwise) { return has(map, key) ? truth_at(map, key) : otherwise; }

  /// An empty list, or map, if it is of another kind, which is a mistake.
  const Json& list_at(const Json& map, const char* key);
  const Json& map_at(const Json& map, const char* key);

  static bool has(const Json& map, const char* key);

 private:
  std::string why_{};
};

}  // namespace s7200::tools
