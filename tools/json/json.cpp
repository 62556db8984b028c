#include "tools/json/json.hpp"

#include "interpreter/base/text/text.hpp"

namespace s7200::tools {
namespace {

using Json = nlohmann::ordered_json;

[[noreturn]] void wrong_kind(const Json& value, std::string_view kind) {
  throw WrongValue(fmt::format("{} is not {}", shown(value), kind));
}

const Json& of_kind(const Json& map, const char* key, Json::value_t kind, std::string_view name, const Json& none) {
  const Json* const value = member(map, key);
  if (!value) return none;
  if (value->type() != kind) taken(*value, key, [&](const Json& wrong) { wrong_kind(wrong, name); });
  return *value;
}

}  // namespace

std::string text_of(const Json& value) {
  if (!value.is_string()) wrong_kind(value, "a text");
  auto text = value.get<std::string>();
  if (text.find('\0') != std::string::npos) wrong_kind(value, "a text without the character NUL");
  return text;
}

bool truth_of(const Json& value) {
  if (!value.is_boolean()) wrong_kind(value, "true or false");
  return value.get<bool>();
}

const Json* member(const Json& map, const char* key) {
  const auto found = map.is_object() ? map.find(key) : map.end();
  return found == map.end() || found->is_null() ? nullptr : &*found;
}

const Json& required(const Json& map, const char* key) {
  if (const Json* const value = member(map, key)) return *value;
  throw WrongValue(fmt::format("{} is missing", key));
}

std::string text_at(const Json& map, const char* key) { return taken(required(map, key), key, text_of); }

std::string text_at(const Json& map, const char* key, std::string_view otherwise) {
  return member(map, key) ? text_at(map, key) : std::string(otherwise);
}

bool truth_at(const Json& map, const char* key) { return taken(required(map, key), key, truth_of); }

bool truth_at(const Json& map, const char* key, bool otherwise) { return member(map, key) ? truth_at(map, key) : otherwise; }

const Json& list_at(const Json& map, const char* key) {
  static const Json kNone = Json::array();
  return of_kind(map, key, Json::value_t::array, "a list", kNone);
}

const Json& map_at(const Json& map, const char* key) {
  static const Json kNone = Json::object();
  return of_kind(map, key, Json::value_t::object, "a map", kNone);
}

const Json& required_list(const Json& map, const char* key) { return required(map, key), list_at(map, key); }

const Json& required_map(const Json& map, const char* key) { return required(map, key), map_at(map, key); }

std::vector<std::string> texts_at(const Json& map, const char* key) {
  const Json* const value = member(map, key);
  std::vector<std::string> texts;
  if (value && value->is_string())
    texts.push_back(text_at(map, key));
  else if (value)
    taken(*value, key, [&](const Json& list) {
      if (!list.is_array()) wrong_kind(list, "a text or a list of texts");
      for (const Json& one : list) texts.push_back(text_of(one));
    });
  return texts;
}

}  // namespace s7200::tools
