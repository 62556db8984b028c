// Records in YAML, as people and scripts note flows: a list of maps, or a document for each, in block or flow style. Each
// record is read by itself: a damaged one costs no other, and memory does not follow the length of the text.
//
//   - dir: tx
//     data: "01 03 00 00 00 02 C4 0B"
//   - {dir: rx, time: 0.05, data: [0x01, 0x03]}
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/rows/lines.hpp"
#include "tools/recordings/rows/named_fields.hpp"
#include "tools/recordings/scan.hpp"
#include "tools/yaml/yaml_fields.hpp"

namespace s7200::tools {
namespace {

constexpr std::size_t kLargestRecord = 1 << 16;  ///< bytes; a frame and what is said of it have a few hundred

/// The bytes of a list: numbers of YAML, `1`, `0x0B`, or pairs of hex digits if each is one and some can be nothing else.
std::optional<Bytes> bytes_of_yaml_list(const std::vector<std::string>& items) {
  const auto is_pair = [](std::string_view item) {
    return item.size() == 2 && is_hex_digit(item[0]) && is_hex_digit(item[1]);
  };
  const auto only_pair = [](std::string_view item) {
    return item.starts_with('0') || !std::ranges::all_of(item, stl::is_digit);
  };
  const bool pairs = std::ranges::all_of(items, is_pair) && std::ranges::any_of(items, only_pair);
  Bytes bytes;
  for (const std::string_view item : items) {
    const auto marked = pairs || item.starts_with("0x") || item.starts_with("0X") ? bytes_of_text(item) : std::nullopt;
    const auto number = marked ? std::nullopt : parse_decimal<std::uint8_t>(item);
    if (marked)
      bytes.insert(bytes.end(), marked->begin(), marked->end());
    else if (number)
      bytes.push_back(*number);
    else
      return {};
  }
  return bytes.empty() ? std::nullopt : std::optional(std::move(bytes));
}

/// The lines of a record, and the number of the first.
struct YamlRecord {
  std::string text{};
  std::size_t number = 0;
};

/// Divides a text into records: each `-` of the outermost list begins one, and so does each document without such a list.
template <typename See>
void for_each_yaml_record(std::string_view text, StopToken stop, See see) {
  constexpr std::size_t kNoList = std::string_view::npos;
  std::size_t number = 0, list = kNoList;  // where the signs of the list stand
  YamlRecord record;
  const auto begin = [&] {
    if (!record.text.empty()) see(record);
    record = {{}, number};
  };
  for (const std::string_view line : Lines(text, stop)) {
    ++number;
    const std::size_t indent = line.find_first_not_of(" \t");
    if (indent == line.npos || line[indent] == '#' || line.starts_with('%')) continue;
    const std::string_view inside = stl::trim(line.substr(indent));
    const bool document = inside == "---" || inside == "...", item = inside.starts_with("- ") || inside == "-";
    if (document || (list != kNoList && !item && indent <= list)) {
      begin();
      list = kNoList;
      if (document) continue;
    } else if (item && (list == kNoList || indent <= list)) {
      begin();
      list = indent;
    }
    if (record.text.empty()) record.number = number;
    if (record.text.size() < kLargestRecord) record.text.append(line).append("\n");
  }
  begin();
}

/// Of a list's item, or of a document that is a map. Nothing for other YAML; trouble for what is none.
Result<NamedFields> fields_of_yaml(const YamlRecord& record) {
  if (record.text.size() >= kLargestRecord) return trouble("it is longer than a frame");
  auto read = read_yaml_fields(record.text);
  if (!read) return read.trouble();
  NamedFields fields;
  for (YamlField& each : *read)
    if (each.items.empty())
      fields.push_back({.name = each.binary ? each.name + " base64" : each.name,
                        .value = std::move(each.value),
                        .quoted = each.quoted || each.binary});
    else
      fields.push_back({.name = each.name,
                        .value = fmt::format("{}", fmt::join(each.items, " ")),
                        .bytes = bytes_of_yaml_list(each.items)});
  return fields;
}

/// Whether a text has a row of a list that is a map, `- dir: tx`, `- {dir: tx}`, or several documents.
bool has_marks_of_yaml(std::string_view text) {
  std::size_t documents = 0;
  for (const std::string_view whole : Lines(text)) {
    const std::string_view line = stl::trim(whole);
    documents += line == "---" ? 1U : 0U;
    if (documents > 1 || (line.starts_with("- ") && line.find(':') != line.npos)) return true;
  }
  return false;
}

}  // namespace

bool looks_like_yaml_records(std::string_view bytes) {
  const std::string_view beginning = beginning_of(bytes);
  if (!is_text(bytes) || !has_marks_of_yaml(beginning)) return false;
  std::size_t frames = 0, others = 0;
  for_each_yaml_record(beginning, {}, [&](const YamlRecord& record) {
    const auto fields = fields_of_yaml(record);
    ++(fields && has_frame(*fields) ? frames : others);
  });
  return frames > others;
}

Result<LineRecording> read_yaml_records(std::string_view bytes, const ReadingChoices& choices) {
  NamedFieldsReader reader;
  for_each_yaml_record(bytes, choices.stop, [&](const YamlRecord& record) {
    const auto fields = fields_of_yaml(record);
    if (!fields)
      reader.take_unreadable(record.number, fields.why());
    else if (fields->empty() || (!record.text.starts_with('-') && !has_frame(*fields)))
      reader.take_other(record.number);
    else
      reader.take(*fields, "", record.number);
  });
  return reader.finish();
}

}  // namespace s7200::tools
