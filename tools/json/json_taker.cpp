#include "tools/json/json_taker.hpp"

namespace s7200::tools {

std::string JsonTaker::text(const Json& value) {
  const auto* const text = value.get_ptr<const std::string*>();
  if (text && text->find('\0') == std::string::npos) return *text;
  fail(fmt::format("{} is not {}", shown(value), text ? "a text without the character NUL" : "a text"));
  return {};
}

bool JsonTaker::truth(const Json& value) {
  if (const auto* const truth = value.get_ptr<const Json::boolean_t*>()) return *truth;
  fail(fmt::format("{} is not true or false", shown(value)));
  return false;
}

bool JsonTaker::has(const Json& map, const char* key) {
  const auto found = map.is_object() ? map.find(key) : map.end();
  return found != map.end() && !found->is_null();
}

const JsonTaker::Json& JsonTaker::member(const Json& map, const char* key) {
  static const Json kNone;
  if (has(map, key)) return *map.find(key);
  fail(fmt::format("{} is missing", key));
  return kNone;
}

const JsonTaker::Json& JsonTaker::element(const Json& list, std::size_t number) {
  static const Json kNone;
  if (list.is_array() && number < list.size()) return list[number];
  fail(fmt::format("{} has no element {}", shown(list), number + 1));
  return kNone;
}

std::string JsonTaker::text_at(const Json& map, const char* key) {
  const Json& value = member(map, key);
  return value.is_null() ? std::string() : of(key, value, [&](const Json& one) { return text(one); });
}

bool JsonTaker::truth_at(const Json& map, const char* key) {
  const Json& value = member(map, key);
  return !value.is_null() && of(key, value, [&](const Json& one) { return truth(one); });
}

const JsonTaker::Json& JsonTaker::list_at(const Json& map, const char* key) {
  static const Json kNone = Json::array();
  const Json& value = member(map, key);
  if (value.is_array()) return value;
  if (!value.is_null()) fail(fmt::format("{}: {} is not a list", key, shown(value)));
  return kNone;
}

const JsonTaker::Json& JsonTaker::map_at(const Json& map, const char* key) {
  static const Json kNone = Json::object();
  const Json& value = member(map, key);
  if (value.is_object()) return value;
  if (!value.is_null()) fail(fmt::format("{}: {} is not a map", key, shown(value)));
  return kNone;
}

}  // namespace s7200::tools
