// An object of JSON in each line, after whatever a logger puts before it: what nodes of Node-RED, loggers and our own users
// write.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "interpreter/base/text.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/lines.hpp"
#include "tools/recordings/named_fields.hpp"

namespace s7200::tools {
namespace {

using nlohmann::json;

constexpr int kDeepest = 16;                            // objects within objects
constexpr std::size_t kLongest = std::size_t{1} << 20;  // characters of a line

/// Counted before it is parsed: the destructor of a deep value would take the stack for each level.
bool is_deep(std::string_view text) {
  std::ptrdiff_t depth = 0, deepest = 0;
  for (const char c : text) {
    depth += c == '{' || c == '[' ? 1 : c == '}' || c == ']' ? -1 : 0;
    deepest = std::max(deepest, depth);
  }
  return deepest > kDeepest;
}

/// Numbers from 0 to 255, or bytes in texts.
std::optional<Bytes> bytes_of_list(const json& list) {
  Bytes bytes;
  for (const json& each : list) {
    if (each.is_number_unsigned() && each.get<std::uint64_t>() <= 0xFF)
      bytes.push_back(static_cast<std::uint8_t>(each.get<std::uint64_t>()));
    else if (const auto some = each.is_string() ? bytes_of_text(each.get<std::string>()) : std::nullopt)
      bytes.insert(bytes.end(), some->begin(), some->end());
    else
      return {};
  }
  return bytes.empty() ? std::nullopt : std::optional(std::move(bytes));
}

/// Those of an object in an object come with the outer name before their own.
void add_fields(const json& object, const std::string& outer, NamedFields& fields) {
  for (const auto& [key, value] : object.items()) {
    const std::string name = outer.empty() ? key : outer + ' ' + key;
    if (value.is_object())
      add_fields(value, name, fields);
    else if (value.is_array())
      fields.push_back(
          {.name = name, .value = value.dump(-1, ' ', true, json::error_handler_t::replace), .bytes = bytes_of_list(value)});
    else
      fields.push_back({.name = name, .value = value.is_string() ? value.get<std::string>() : value.dump()});
  }
}

struct Record {
  std::string_view before{};
  std::optional<NamedFields> fields{};  ///< nothing: it is not JSON
};
/// Nothing if there is no object in the line.
std::optional<Record> record_of(std::string_view line) {
  const std::size_t begin = line.find("{\"");
  if (begin == std::string_view::npos || line.size() > kLongest) return {};
  std::string_view text = stl::trim(line.substr(begin));
  if (text.ends_with(',')) text.remove_suffix(1);  // a row of a list
  Record record{.before = line.substr(0, begin)};
  if (is_deep(text)) return record;
  const json object = json::parse(text, nullptr, false);
  if (!object.is_object()) return record;
  add_fields(object, "", record.fields.emplace());
  return record;
}

}  // namespace

bool looks_like_json_lines(std::string_view bytes) {
  return is_text(bytes) && std::ranges::any_of(Lines(beginning_of(bytes)), [](std::string_view line) {
           const auto record = record_of(line);
           return record && record->fields && has_frame(*record->fields);
         });
}

std::optional<LineRecording> read_json_lines(std::string_view bytes, const ReadingChoices&, std::string&) {
  NamedFieldsReader reader;
  std::size_t number = 0;
  for (const std::string_view line : Lines(bytes)) {
    ++number;
    const auto record = record_of(line);
    if (record && record->fields)
      reader.take(*record->fields, record->before, number);
    else if (record)
      reader.take_unreadable(number, stl::trim(line));
    else if (line.find_first_not_of(" \t[]") != std::string_view::npos)
      reader.take_other(number);
  }
  return reader.finish();
}

}  // namespace s7200::tools
