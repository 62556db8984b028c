// What is in a message, whoever has written it: nothing of it is believed before it has been looked at.
#pragma once

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "tools/json/json.hpp"

namespace s7200::tools::dap {

using Json = nlohmann::ordered_json;

/// A request that cannot be done, and why.
class Refused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Empty if it is not there, or not a text.
inline std::string text_in(const Json& message, const char* key) {
  const auto found = message.is_object() ? message.find(key) : message.end();
  return found != message.end() && found->is_string() ? found->get<std::string>() : "";
}

/// 0 if it is not there, or not a whole number.
inline std::int64_t number_in(const Json& message, const char* key) {
  const auto found = message.is_object() ? message.find(key) : message.end();
  return found != message.end() ? number_from<std::int64_t>(*found).value_or(0) : 0;
}

inline Json object_in(const Json& message, const char* key) {
  const auto found = message.is_object() ? message.find(key) : message.end();
  return found != message.end() && found->is_object() ? *found : Json::object();
}

/// A number of bytes, lines or instructions, such that sums of a few of them are numbers too.
inline std::int64_t amount_in(const Json& arguments, const char* key, std::int64_t otherwise) {
  constexpr std::int64_t kMost = 1'000'000'000;
  return std::clamp<std::int64_t>(number_at<std::int64_t>(arguments, key, kWhole<std::int64_t>, otherwise), -kMost, kMost);
}

/// The same of one that is not negative; 0 if it is left out.
inline std::size_t amount_from_0(const Json& arguments, const char* key) {
  return static_cast<std::size_t>(std::max<std::int64_t>(0, amount_in(arguments, key, 0)));
}

}  // namespace s7200::tools::dap
