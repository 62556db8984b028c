// An object of JSON in each line, after whatever a logger puts before it: what nodes of Node-RED, loggers and our own users
// write.
#include <algorithm>

#include "interpreter/base/text.hpp"
#include "tools/json/json.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/lines.hpp"
#include "tools/recordings/named_fields.hpp"

namespace s7200::tools {
namespace {

using json = nlohmann::ordered_json;

constexpr JsonLimits kLimits{.bytes = std::size_t{1} << 20, .depth = 16, .members = 1000};

/// Numbers from 0 to 255, or bytes in texts.
std::optional<Bytes> bytes_of_list(const json& list) {
  Bytes bytes;
  for (const json& each : list) {
    if (const auto byte = number_from<std::uint8_t>(each))
      bytes.push_back(*byte);
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
  if (begin == std::string_view::npos) return {};
  std::string_view text = stl::trim(line.substr(begin));
  if (text.ends_with(',')) text.remove_suffix(1);  // a row of a list
  Record record{.before = line.substr(0, begin)};
  std::string why;
  const auto object = parse_json(text, why, kLimits);
  if (object && object->is_object()) add_fields(*object, "", record.fields.emplace());
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
