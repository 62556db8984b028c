#include "tools/master/words.hpp"

#include "interpreter/base/text/numbers.hpp"
#include "tools/master/written_values.hpp"

namespace s7200::tools {

void refuse(const std::string& why) { throw std::invalid_argument(why); }

std::optional<std::pair<std::string, std::string>> split_at(const std::string& text, char separator) {
  const std::size_t place = text.find(separator);
  if (place == std::string::npos) return {};
  return std::pair{text.substr(0, place), text.substr(place + 1)};
}

std::vector<std::string> split_at_commas(const std::string& text) {
  std::vector<std::string> parts;
  std::string rest = text;
  while (const auto next = split_at(rest, ',')) {
    parts.push_back(next->first);
    rest = next->second;
  }
  parts.push_back(rest);
  return parts;
}

std::vector<std::int64_t> values_of(const std::string& text, std::int64_t least, std::int64_t most) {
  std::vector<std::int64_t> values;
  for (const std::string& part : split_at_commas(text)) values.push_back(parse_number(part, least, most, "value"));
  return values;
}

Bytes byte_values_of(const std::string& text) {
  Bytes bytes;
  for (const std::int64_t value : values_of(text, INT8_MIN, UINT8_MAX)) bytes.push_back(static_cast<std::uint8_t>(value));
  return bytes;
}

serial::Frame parse_hex(const std::string& text) {
  serial::ParsedFrame parsed = serial::parse_hex_frame(text);
  if (!parsed.ok())
    refuse(fmt::format("'{}': column {}: {}", stl::shortened(text), parsed.errors[0].column, parsed.errors[0].message));
  return std::move(parsed.frame);
}

ProtocolOption word_option(std::string_view name, std::string_view value, std::string meaning, std::string_view kind,
                           std::span<const std::string_view> words) {
  const auto fault = [kind, words](const std::string& word) {
    return std::ranges::find(words, word) != words.end()
               ? std::string()
               : fmt::format("'{}' is not {}; there are {}", stl::shortened(word), kind, fmt::join(words, ", "));
  };
  return {name, value, std::move(meaning), std::string(words.front()), fault};
}

std::size_t ProtocolUse::chosen(std::string_view option, std::span<const std::string_view> words) const {
  const auto found = given.find(option);
  if (found == given.end()) return 0;
  return static_cast<std::size_t>(std::ranges::find(words, found->second) - words.begin());
}

void WordParser::station(const Words& operands) {
  station_ = static_cast<std::uint8_t>(parse_number(operands[0], 0, last_station_, "station"));
  actions_.push_back({.kind = MasterAction::Kind::Station, .text = text_, .station = station_});
}

void WordParser::wait(const Words& operands) {
  const auto duration = parse_duration_in(operands[0], {0, kLongestDuration});
  if (!duration) refuse(fmt::format("{}: {}", text_, duration.why()));
  actions_.push_back({.kind = MasterAction::Kind::Wait, .text = text_, .station = station_, .duration = *duration});
}

void WordParser::add(std::shared_ptr<ProtocolRequest> request) {
  actions_.push_back({.text = text_, .station = station_, .request = std::move(request)});
}

void WordParser::add_raw(const std::string& text, std::uint8_t station, std::shared_ptr<ProtocolRequest> request) {
  actions_.push_back(
      {.kind = MasterAction::Kind::Raw, .text = "raw " + text, .station = station, .request = std::move(request)});
}

}  // namespace s7200::tools
